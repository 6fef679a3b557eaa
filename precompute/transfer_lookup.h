#pragma once
/// What a renderer reads from one vertex's maps, in double precision: the reference for shaders/stage/transfer.glsl.

#include <glm/glm.hpp>

#include "assets/transfer/transfer.h"
#include "precompute/visibility/octahedral_grid.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {

/// Share of a normalised SG lobe above the vertex's horizon that arrives. row: the maps (SSDF, then levels).
/// softness: of the SSDF (ClusteredTransfer::ssdfSoftness).
double visibleShare(const float* row, int resolution, const std::vector<VisibilityLevel>& levels, float softness, glm::vec3 axis, double sharpness);

}  // namespace chiaro
