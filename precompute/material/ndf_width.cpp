#include "precompute/material/ndf_width.h"

#include <cmath>

#include "precompute/material/material_fit.h"
#include "precompute/material/reconstruction_error.h"

namespace chiaro {

NdfWidth fitNdfWidth(int kind, const std::function<double(double)>& ndf) {
  const auto at = [&](double width) {
    constexpr int kPoints = 2000;
    const auto model = fittedNdf(kind, width);
    double aa = 0.0, ab = 0.0, bb = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      // As fine near the normal as the sharpest width.
      const double u = (i + 0.5) / kPoints, angle = lobe64::kHalfPi * u * u * u, step = 3.0 * lobe64::kHalfPi * u * u / kPoints,
                   weight = std::sin(angle) * step;
      const double a = model(angle), b = ndf(angle);
      aa += weight * a * a, ab += weight * a * b, bb += weight * b * b;
    }
    const double scale = ab / aa;
    return NdfWidth{.kind = kind, .width = width, .scale = scale, .error = std::sqrt(std::max(0.0, 1.0 - ab * ab / (aa * bb)))};
  };
  constexpr int kScan = 60;
  const double ratio = std::pow(kMostFitWidth / kLeastFitWidth, 1.0 / (kScan - 1));
  NdfWidth best = at(kLeastFitWidth);
  for (int i = 1; i < kScan; ++i)
    if (const NdfWidth one = at(kLeastFitWidth * std::pow(ratio, i)); one.error < best.error) best = one;
  // Golden section between the neighbours of the best.
  constexpr double kGolden = 0.6180339887498949;
  double low = std::log(std::max(best.width / ratio, kLeastFitWidth)),
         high = std::log(std::min(best.width * ratio, kMostFitWidth));
  while (high - low > 1e-7) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (at(std::exp(a)).error <= at(std::exp(b)).error)
      high = b;
    else
      low = a;
  }
  const NdfWidth fine = at(std::exp(0.5 * (low + high)));
  return fine.error < best.error ? fine : best;
}

}  // namespace chiaro
