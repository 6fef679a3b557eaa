#pragma once
/// What each vertex sees of the sphere.

#include <cstdint>
#include <vector>

#include "precompute/embree/ray_scene.h"
#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/viewpoints.h"

namespace chiaro {

/// One bit per texel of the sphere about one vertex: bit `lane` of word `tile` of OctahedralGrid.
using TexelBits = std::vector<std::uint16_t>;

inline bool texelBit(const std::uint16_t* bits, std::size_t texel) { return (bits[texel / 16] >> (texel % 16) & 1) != 0; }

/// Texels whose centre is above the horizon of `normal`: dot > 0. `cosine` gets the dot of every texel (#texels).
void texelsAbove(const OctahedralGrid& grid, glm::vec3 normal, AlignedFloats& cosine, TexelBits& above);

/// Traces from `viewpoint`. visible: a bit where no surface is met. One-sided: only directions in `above` are traced, the bits of
/// the others are those of the texel that holds their mirror image in the horizon. Double-sided: the others are traced from the back.
/// Returns the number of rays.
std::uint64_t traceVisibility(const RayScene& rays, const OctahedralGrid& grid, const Viewpoint& viewpoint, const TexelBits& above,
                              TexelBits& visible);

/// The texel of `above` that holds `direction`, or, next to the horizon, is nearest to it. `direction` is above the horizon itself.
std::size_t nearestAbove(const OctahedralGrid& grid, const TexelBits& above, glm::vec3 direction);

/// For every texel not in `above`: the bit of the texel of `above` that holds (or, next to the horizon, is nearest to) its mirror image.
void mirrorBelowHorizon(const OctahedralGrid& grid, glm::vec3 normal, const TexelBits& above, TexelBits& visible);

}  // namespace chiaro
