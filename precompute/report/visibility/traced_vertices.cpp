#include "precompute/report/visibility/traced_vertices.h"

#include <algorithm>

#include "precompute/parallel.h"

namespace chiaro {

TracedVertices::TracedVertices(const VisibilityInput& input, const OctahedralGrid& grid) : grid_(grid), vertices_(input.encoded) {
  vertices_.insert(vertices_.end(), input.basis.begin(), input.basis.end());
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  visible_.resize(vertices_.size());
  parallelBlocks(input.threads, vertices_.size(), [&](std::size_t i) {
    const auto& viewpoint = input.viewpoints[vertices_[i]];
    AlignedFloats cosine(grid.texelCount);
    TexelBits above;
    texelsAbove(grid, viewpoint.normal, cosine, above);
    traceVisibility(input.rays, grid, viewpoint, above, visible_[i]);
  });
}

void VertexMaps::visibility(const Viewpoint& viewpoint, const TexelBits& visible, float* map) {
  texelsAbove(grid_, viewpoint.normal, cosine_, above_);
  for (std::size_t t = 0; t < grid_.texelCount; ++t)
    map[grid_.rowMajor[t]] = texelBit(above_.data(), t) && texelBit(visible.data(), t) ? 1.0f : 0.0f;
}

void VertexMaps::ssdfWithHorizon(const Viewpoint& viewpoint, const TexelBits& visible, float* map) {
  texelsAbove(grid_, viewpoint.normal, cosine_, above_);
  seen_ = visible;
  for (std::size_t tile = 0; tile < grid_.tileCount; ++tile) seen_[tile] = static_cast<std::uint16_t>(seen_[tile] & above_[tile]);
  // To the transform a double-sided vertex is one without a horizon of its own: whatever differs is a boundary.
  transform_(viewpoint.normal, true, above_, seen_, above_, seen_, map);
}

void VertexMaps::ssdfOfOccluders(const Viewpoint& viewpoint, const TexelBits& visible, float* map) {
  texelsAbove(grid_, viewpoint.normal, cosine_, above_);
  transform_(viewpoint.normal, viewpoint.doubleSided, above_, visible, above_, visible, map);
}

}  // namespace chiaro
