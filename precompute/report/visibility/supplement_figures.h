#pragma once
/// Figures 7 and 10 of the supplement of Wang et al. 2009, for one scene.

#include <vector>

#include "precompute/figure/figure.h"
#include "precompute/report/visibility/visibility_study.h"

namespace chiaro {

/// `product`: squared error of products with a signed distance by sharpness. `terms_vertices_10`, `_100`, `_1000` and `terms_triangles_...`: mean |error| of the visible fraction by the number of
/// terms a vertex (16, 25, 49, 100) of the paper's PCA of signed distances, of Haar wavelets of visibility and of spherical harmonics. Places that no point of the study is at are left out.
std::vector<Figure> supplementFigures(const VisibilityStudy& study, const VisibilitySettings& settings, const ProgressHandler& progress);

}  // namespace chiaro
