#include "precompute/report/metrics/plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/error.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

constexpr int kRowsOfABlock = 16;

bool whole(const ImageRgb& image) {
  return image.width > 0 && image.height > 0 &&
         image.texels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

double meanInside(const MetricMap& map, const PixelMask& mask, int margin) {
  double sum = 0.0;
  std::size_t count = 0;
  for (int y = margin; y < map.plane.height - margin; ++y)
    for (int x = margin; x < map.plane.width - margin; ++x) {
      const std::size_t i = map.plane.index(x, y);
      if (!mask.empty() && mask[i] == 0) continue;
      sum += map.plane.values[i];
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

bool anyInside(const MetricMap& map, const PixelMask& mask, int margin) {
  for (int y = margin; y < map.plane.height - margin; ++y)
    for (int x = margin; x < map.plane.width - margin; ++x)
      if (mask.empty() || mask[map.plane.index(x, y)] != 0) return true;
  return false;
}

}  // namespace

double meanOf(const MetricMap& map, const PixelMask& mask) {
  if (!mask.empty() && mask.size() != map.plane.values.size())
    throw Error(ExitCode::failed, "report", "a mask has another size than its picture", "this is an error in the program");
  return meanInside(map, mask, anyInside(map, mask, map.margin) ? map.margin : 0);
}

void requireComparable(const ImageRgb& a, const ImageRgb& b) {
  if (!whole(a) || !whole(b) || a.width != b.width || a.height != b.height)
    throw Error(ExitCode::failed, "report", "the pictures to compare differ in size or are empty", "give two of the same size");
}

bool isFinite(const glm::vec3& color) { return std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b); }

void forEachRow(int height, int threads, const std::function<void(int)>& row) {
  const int blocks = (height + kRowsOfABlock - 1) / kRowsOfABlock;
  parallelBlocks(threads, static_cast<std::size_t>(blocks), [&](std::size_t block) {
    const int first = static_cast<int>(block) * kRowsOfABlock;
    for (int y = first; y < std::min(height, first + kRowsOfABlock); ++y) row(y);
  });
}

}  // namespace chiaro
