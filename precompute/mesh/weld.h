#pragma once
/// Removing what a mesh should not have: copies of vertices, triangles without area, triangles said twice, vertices unused.

#include <cstdint>
#include <vector>

#include "assets/scene/scene.h"
#include "precompute/bake.h"

namespace chiaro {

/// For each position the index of the first bitwise equal one (-0 equals 0).
std::vector<std::uint32_t> weldPositions(const std::vector<glm::vec3>& positions);

/// Merges the vertices whose every attribute is bitwise identical, drops degenerate and duplicate triangles, then the
/// vertices that no triangle uses. The order of what stays is kept. Adds to the counts of `report`.
///
/// Degenerate: two corners at one position, or an altitude below 1e-7 of the longest edge or below the rounding of the
/// coordinates: such a triangle has no direction that could be trusted. Duplicate: the corners' positions and winding of an
/// earlier triangle of this primitive.
void cleanPrimitive(Primitive& primitive, RepairReport& report);

/// Keeps the vertices `keep` names, in that order; `indices` are left alone.
void selectVertices(Primitive& primitive, const std::vector<std::uint32_t>& keep);

}  // namespace chiaro
