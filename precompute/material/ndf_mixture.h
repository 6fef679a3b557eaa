#pragma once
/// A distribution of microfacet normals, any, as spherical Gaussians about the normal.

#include <functional>
#include <vector>

#include "shaders/cpp/lobe.h"

namespace chiaro {

struct NdfMixture {
  std::vector<lobe64::SphericalGaussian> lobes;  ///< about +z, amplitudes >= 0 in the distribution's own unit, sharpest first
  double error = 0.0;  ///< root of the squared difference over the hemisphere, by that of the distribution
};

/// The `count` (1..4) lobes of least L2 error over the hemisphere, by Ceres. `ndf`: by angle from the normal, radians; finite, >= 0, not all 0.
NdfMixture fitNdfMixture(const std::function<double(double)>& ndf, int count);

}  // namespace chiaro
