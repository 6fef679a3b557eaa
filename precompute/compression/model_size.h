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

/// A quarter for the functions, of 4 bits a value and `columns` values; a cluster for 80 vertices at kUsualBytes (measured on the built-in
/// scene: from half to twice as many of either are within a twentieth of the best).
/// leastFunctions: whatever the bytes.
inline ModelSize modelSize(double bytesPerVertex, std::size_t vertices, std::size_t columns, int leastFunctions) {
  const double all = bytesPerVertex * static_cast<double>(vertices), usual = bytesPerVertex / kUsualBytes;
  const auto within = [](double value, double least, double most) { return static_cast<int>(std::clamp(value, least, std::max(least, most))); };
  return {.functions = within(0.25 * all / (0.5625 * static_cast<double>(columns)), leastFunctions, std::min(320.0 * usual, 1024.0)),
          .clusters = within(all / (80.0 * kUsualBytes), 1.0, std::min(1024.0 * usual, 4096.0))};
}

/// What a target error tries, and after these all terms of more functions.
inline constexpr double kByteRungs[] = {32, 48, 72, 104, 152, 224, 328, 480};
inline constexpr int kMostNeeded = 384;  // functions: the built-in scene's rows are within .02 of the truth

}  // namespace chiaro
