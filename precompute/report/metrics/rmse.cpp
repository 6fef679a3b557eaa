#include "precompute/report/metrics/rmse.h"

#include <cmath>
#include <limits>

namespace chiaro {

double rootMeanSquareError(const ImageRgb& a, const ImageRgb& b, const PixelMask& mask) {
  requireComparable(a, b);
  MetricMap squares;
  squares.plane = Plane(a.width, a.height);
  for (std::size_t i = 0; i < a.texels.size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(a.texels[i]) - glm::dvec3(b.texels[i]);
    const bool defined = isFinite(a.texels[i]) && isFinite(b.texels[i]);
    squares.plane.values[i] = defined ? glm::dot(difference, difference) / 3.0 : std::numeric_limits<double>::quiet_NaN();
  }
  return std::sqrt(meanOf(squares, mask));
}

double peakSignalToNoise(double rmse, double peak) { return 20.0 * std::log10(peak / rmse); }

}  // namespace chiaro
