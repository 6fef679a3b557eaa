#pragma once
/// How many functions and clusters a number of bytes a vertex is best spent on.

#include <algorithm>
#include <cstddef>

namespace chiaro {

/// The paper's own: 48 weights of 16 bits and their basis, on some fifty thousand vertices (Wang et al. 2009, section 6).
inline constexpr double kUsualBytes = 104.0;

struct ModelSize {
  int functions = 0;
  int clusters = 0;
};

/// A function for 128 vertices and a cluster for 64 at kUsualBytes, in proportion to the bytes; steps of rounding do the rest. Limits are those of time and of
/// the renderer's memory. finer: sampled texels a stored one, a side; where that is 1 edges are uncertain by half a texel, and half as much of a model says as much.
inline ModelSize modelSize(double bytesPerVertex, std::size_t vertices, int finer) {
  const double usual = bytesPerVertex / kUsualBytes * (finer > 1 ? 1.0 : 0.5), count = static_cast<double>(vertices) * usual;
  const auto within = [](double value, double least, double most) { return static_cast<int>(std::clamp(value, least, std::max(least, most))); };
  return {.functions = within(count / 128.0, 32.0, std::clamp(400.0 * usual, 128.0, 1024.0)),
          .clusters = within(count / 64.0, 1.0, std::min(1024.0 * usual, 4096.0))};
}

/// What a target error tries, and after these all terms of more functions.
inline constexpr double kByteRungs[] = {4, 6, 10, 16, 24, 36, 52, 72, 104, 152, 224, 328, 480};
inline constexpr int kMostNeeded = 640;  // functions: the built-in scene's rows are within .01 of what was traced

}  // namespace chiaro
