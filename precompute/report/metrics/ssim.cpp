#include "precompute/report/metrics/ssim.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "precompute/report/metrics/separable_filter.h"

namespace chiaro {
namespace {

constexpr int kRadius = 5;
constexpr double kDeviation = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

double luma(const glm::vec3& color) {
  const glm::dvec3 c = glm::clamp(glm::dvec3(color), 0.0, 1.0);
  return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result(a.width, a.height);
  for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] = a.values[i] * b.values[i];
  return result;
}

Plane windowed(const Plane& plane, int threads) {
  const Taps window =
      normalised(tapsOf(kRadius, [](int k) { return std::exp(-0.5 * static_cast<double>(k * k) / (kDeviation * kDeviation)); }));
  return filterAlongY(filterAlongX(plane, window, Border::cut, threads), window, Border::cut, threads);
}

}  // namespace

MetricMap ssim(const ImageRgb& a, const ImageRgb& b, int threads) {
  requireComparable(a, b);
  Plane x(a.width, a.height), y(a.width, a.height);
  for (std::size_t i = 0; i < a.texels.size(); ++i)
    if (isFinite(a.texels[i]) && isFinite(b.texels[i])) x.values[i] = luma(a.texels[i]), y.values[i] = luma(b.texels[i]);
  const Plane meanX = windowed(x, threads), meanY = windowed(y, threads);
  const Plane xx = windowed(product(x, x), threads), yy = windowed(product(y, y), threads), xy = windowed(product(x, y), threads);
  MetricMap map{Plane(a.width, a.height), kRadius};
  for (std::size_t i = 0; i < a.texels.size(); ++i) {
    const double mx = meanX.values[i], my = meanY.values[i];
    const double varianceX = xx.values[i] - mx * mx, varianceY = yy.values[i] - my * my, covariance = xy.values[i] - mx * my;
    const bool defined = isFinite(a.texels[i]) && isFinite(b.texels[i]);
    map.plane.values[i] =
        defined ? (2.0 * mx * my + kC1) * (2.0 * covariance + kC2) / ((mx * mx + my * my + kC1) * (varianceX + varianceY + kC2))
                : std::numeric_limits<double>::quiet_NaN();
  }
  return map;
}

}  // namespace chiaro
