#pragma once
/// How well a half-space at the signed distance stands for visibility in products with a spherical Gaussian (supplement of Wang et al. 2009, figure 7).

#include <cstdint>
#include <functional>
#include <vector>

#include "precompute/report/visibility/visibility_method.h"

namespace chiaro {

/// Squared errors relative to the square of the truth, both summed over all points and axes, by sharpness.
struct ProductError {
  std::vector<double> inner;   ///< of the inner product: the integral of G V
  std::vector<double> vector;  ///< of the vector product: G times a share, for G V as a function
};

/// 1, 2, 4, ... 4096.
const std::vector<double>& productSharpness();

/// Errors of each of `methods`, which must not need Lobe::directions (they read a map at the axis), at 16 random axes above each point's horizon; last, an entry with the
/// true share: what of the vector product's error no share can take away. raysPerLobe: of the truth. progress: share done. Same figures for any number of threads.
std::vector<ProductError> productErrors(const RayScene& rays, const std::vector<SurfacePoint>& points, const std::vector<const VisibilityMethod*>& methods, int raysPerLobe, std::uint32_t seed,
                                        int threads, const std::function<void(double)>& progress);

}  // namespace chiaro
