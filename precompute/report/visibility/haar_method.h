#pragma once
/// Visibility in the largest Haar wavelets of each vertex (Ng et al. 2003, 2004).

#include <memory>

#include "precompute/report/visibility/visibility_method.h"

namespace chiaro {

/// One method for each number of terms: a cube map of 6 x 64^2 binary texels, orthonormal wavelets a face, of each vertex those of
/// largest magnitude. 16 bits a value with one scale for all, and 16 a wavelet's index. A lobe is integrated over the texels.
std::vector<std::unique_ptr<VisibilityMethod>> makeHaarMethods(const VisibilityInput& input, const std::vector<int>& terms);

}  // namespace chiaro
