#pragma once
/// Visibility in spherical harmonics.

#include <memory>

#include "precompute/report/visibility/visibility_method.h"
#include "precompute/visibility/octahedral_grid.h"

namespace chiaro {

/// One method for each number of bands (5, 7, 10: 25, 49, 100 coefficients): the projection of binary visibility, 16 bits a
/// coefficient with one scale for all. A lobe's fraction weights the bands (lobeBands), which is exact for any sharpness.
std::vector<std::unique_ptr<VisibilityMethod>> makeShMethods(const VisibilityInput& input, const std::vector<int>& bands);

/// Coefficients of a function over the sphere from its values at the texels (tiled order of `grid`), by their exact solid angles.
std::vector<double> projectSh(const OctahedralGrid& grid, const std::vector<float>& values, int bands);

}  // namespace chiaro
