#pragma once
/// What the error metrics compute on, and what they give back.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "assets/image/image.h"

namespace chiaro {

/// One channel of a picture, row-major from the top left.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  double at(int x, int y) const { return values[index(x, y)]; }
  double& at(int x, int y) { return values[index(x, y)]; }
};

/// 1 where a pixel counts, 0 where not; empty: all count.
using PixelMask = std::vector<std::uint8_t>;

/// A metric's value at each pixel: NaN where either picture holds a NaN or an infinity.
struct MetricMap {
  Plane plane;
  int margin = 0;  ///< pixels this near to the border see a window that is cut there; meanOf() leaves them out
};

/// Over the pixels that count and are no nearer to the border than the margin; where there are none of these, over all that count. NaN when one of
/// them is NaN, or none counts.
double meanOf(const MetricMap& map, const PixelMask& mask = {});

/// Throws Error (failed) when the sizes differ, a picture is empty, or has more or fewer texels than its size says.
void requireComparable(const ImageRgb& a, const ImageRgb& b);

bool isFinite(const glm::vec3& color);

/// row(y) for every y, over threads (0: all cores). Rows write to places of their own.
void forEachRow(int height, int threads, const std::function<void(int)>& row);

}  // namespace chiaro
