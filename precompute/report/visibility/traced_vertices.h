#pragma once
/// What some vertices of a scene see, traced once and handed out in the forms that the methods store.

#include <vector>

#include "precompute/report/visibility/visibility_method.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// One bit a texel: 512 bytes a vertex at resolution 64.
class TracedVertices {
 public:
  /// Traces VisibilityInput::encoded and ::basis.
  TracedVertices(const VisibilityInput& input, const OctahedralGrid& grid);

  const OctahedralGrid& grid() const { return grid_; }
  const TexelBits& visible(std::size_t vertex) const { return visible_[slotOf(vertices_, vertex)]; }

 private:
  const OctahedralGrid& grid_;
  std::vector<std::size_t> vertices_;  ///< increasing
  std::vector<TexelBits> visible_;
};

/// Maps of one vertex at a time; one for each thread. Row-major texels.
class VertexMaps {
 public:
  explicit VertexMaps(const OctahedralGrid& grid) : grid_(grid), transform_(grid, grid), cosine_(grid.texelCount) {}

  /// 1 where the sphere is seen and above the horizon, else 0.
  void visibility(const Viewpoint& viewpoint, const TexelBits& visible, float* map);
  /// Radians, the horizon a boundary like any other (Wang et al. 2009).
  void ssdfWithHorizon(const Viewpoint& viewpoint, const TexelBits& visible, float* map);
  /// Radians, as a bake stores it: of the other surfaces alone.
  void ssdfOfOccluders(const Viewpoint& viewpoint, const TexelBits& visible, float* map);

 private:
  const OctahedralGrid& grid_;
  SsdfTransform transform_;
  AlignedFloats cosine_;
  TexelBits above_, seen_;
};

using VertexMap = void (VertexMaps::*)(const Viewpoint&, const TexelBits&, float*);

}  // namespace chiaro
