#pragma once
/// The shifted gamma distribution (Bagher, Soler, Holzschuch, Accurate Fitting of Measured Reflectances using a Shifted Gamma Micro-facet
/// Distribution, 2012, eq. 11 to 18), with the normalisation of the published table (dj_brdf.h), each channel apart:
///   rho = rhoD / pi + rhoS F G1(wi) G1(wo) D / (pi (n.wi) (n.wo))
///   D = kap e^-x / (pi x^p cos^4), x = alpha + tan^2(half) / alpha;   F = f0 - f1 c + (1 - f0) (1 - c)^5, c = cos(diff)
///   G1 = 1 + lambda (1 - e^(c max(theta - theta0, 0)^k)), in [0, 1]

#include <array>

#include "precompute/material/measured_reflectance.h"

namespace chiaro {

struct SgdChannel {
  double rhoD = 0.0, rhoS = 0.0, alpha = 0.1, p = 0.0, f0 = 0.0, f1 = 0.0, kap = 1.0, lambda = 0.0, c = 0.0, k = 1.0,
         theta0 = 0.0;
};

ReflectanceFunction sgdReflectance(const std::array<SgdChannel, 3>& channels);

}  // namespace chiaro
