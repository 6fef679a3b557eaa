#include "precompute/material/fit_samples.h"

#include <cmath>

#include "assets/error.h"
#include "precompute/material/half_difference.h"
#include "precompute/material/merl_file.h"

namespace chiaro {

using lobe64::Vec3;

std::vector<FitSample> fitSamples(const ReflectanceFunction& reflectance, double widest, const FitGrid& grid, const std::string& where) {
  constexpr std::size_t kLeast = 100;
  const double least = std::cos(widest);
  const std::size_t stepD = MerlTable::kThetaDiff / static_cast<std::size_t>(grid.thetaDiff),
                    stepP = MerlTable::kPhiDiff / static_cast<std::size_t>(grid.phiDiff);
  std::vector<FitSample> samples;
  double total = 0.0;
  for (std::size_t h = 0; h < MerlTable::kThetaHalf; ++h)
    for (std::size_t d = stepD / 2; d < MerlTable::kThetaDiff; d += stepD)
      for (std::size_t p = stepP / 2; p < MerlTable::kPhiDiff; p += stepP) {
        const HalfDifference angles{MerlTable::thetaHalfOf(h), MerlTable::thetaDiffOf(d), MerlTable::phiDiffOf(p)};
        const auto [wo, wi] = directionPair(angles);
        if (!(wo.z >= least && wi.z >= least && wo.z > 0.0 && wi.z > 0.0)) continue;
        const Vec3 rho = reflectance(wo, wi);
        if (!(rho.x >= 0.0 && rho.y >= 0.0 && rho.z >= 0.0 && rho.x + rho.y + rho.z < 1e30)) continue;
        // The steps of thetaHalf grow as 2 h + 1.
        const double weight = halfDifferenceMeasure(angles) * (2.0 * static_cast<double>(h) + 1.0);
        samples.push_back({.wo = wo,
                           .wi = wi,
                           .rho = rho,
                           .fresnel = lobe64::fresnelSchlickWeight(std::cos(angles.thetaDiff)),
                           .weight = weight});
        total += weight;
      }
  if (samples.size() < kLeast)
    throw inputError(where,
                     "has " + std::to_string(samples.size()) + " measured pairs of directions within " +
                         std::to_string(std::lround(widest * 180.0 / lobe64::kPi)) + " degrees",
                     "a fit needs more: measure again");
  for (auto& sample : samples) sample.weight /= total;
  return samples;
}

}  // namespace chiaro
