#include "precompute/report/metrics/separable_filter.h"

#include <algorithm>

namespace chiaro {
namespace {

/// One value of a line of `count` values that lie `stride` apart.
double filteredAt(const double* line, std::size_t stride, int count, int at, const Taps& taps, Border border) {
  const int radius = static_cast<int>(taps.size()) / 2;
  double sum = 0.0, weights = 0.0;
  for (int k = -radius; k <= radius; ++k) {
    if (border == Border::cut && (at + k < 0 || at + k >= count)) continue;
    const double weight = taps[static_cast<std::size_t>(k + radius)];
    sum += weight * line[static_cast<std::size_t>(std::clamp(at + k, 0, count - 1)) * stride];
    weights += weight;
  }
  return border == Border::cut ? sum / weights : sum;
}

}  // namespace

Taps tapsOf(int radius, const std::function<double(int)>& weight) {
  Taps taps;
  for (int k = -radius; k <= radius; ++k) taps.push_back(weight(k));
  return taps;
}

Taps normalised(Taps taps) {
  double sum = 0.0;
  for (const double tap : taps) sum += tap;
  for (double& tap : taps) tap /= sum;
  return taps;
}

Plane filterAlongX(const Plane& plane, const Taps& taps, Border border, int threads) {
  Plane result(plane.width, plane.height);
  forEachRow(plane.height, threads, [&](int y) {
    for (int x = 0; x < plane.width; ++x)
      result.at(x, y) = filteredAt(&plane.values[plane.index(0, y)], 1, plane.width, x, taps, border);
  });
  return result;
}

Plane filterAlongY(const Plane& plane, const Taps& taps, Border border, int threads) {
  Plane result(plane.width, plane.height);
  forEachRow(plane.height, threads, [&](int y) {
    for (int x = 0; x < plane.width; ++x)
      result.at(x, y) =
          filteredAt(&plane.values[plane.index(x, 0)], static_cast<std::size_t>(plane.width), plane.height, y, taps, border);
  });
  return result;
}

}  // namespace chiaro
