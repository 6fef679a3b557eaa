#pragma once
/// What each vertex's transfer is before compression: one row of floats, made by tracing.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "assets/transfer/clustered.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/visibility/adaptive_visibility.h"
#include "precompute/visibility/fractions.h"
#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/prefilter.h"
#include "precompute/visibility/viewpoints.h"

namespace chiaro {

/// What tracing cost; seconds are of all threads together.
struct TraceTally {
  std::uint64_t rays = 0;
  double visibilitySeconds = 0.0, ssdfSeconds = 0.0, filterSeconds = 0.0;
  void operator+=(const TraceTally& other);
};

/// A row: the SSDF (resolution^2, radians, clamped to [-clamp, clamp], softened), the levels' prefiltered visibility, the fixed lobes' visible fractions.
class TransferRows {
 public:
  struct Layout {
    int resolution = 64;          ///< of the SSDF
    int samplingResolution = 64;  ///< of what is traced: `resolution` times a power of two
    float clamp = 0.0f;           ///< radians, at most pi / 2
    float softness = 0.0f;        ///< of the stored SSDF (ClusteredTransfer::ssdfSoftness)
    float leastOccluder = 0.0f;   ///< radians; no occluder as wide is missed; 0: no such promise (AdaptiveSphere)
    std::vector<VisibilityLevel> levels;
    std::vector<glm::vec3> directions;
    float directionSharpness = 0.0f;
  };
  TransferRows(const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const Layout& layout);

  std::size_t texels() const { return stored_.texelCount; }
  std::size_t levelTexels() const { return prefilter_.size(); }
  std::size_t size() const { return texels() + levelTexels() + layout_.directions.size(); }
  const Layout& layout() const { return layout_; }
  const OctahedralGrid& storedGrid() const { return stored_; }

  /// Rows of `vertices`, `stride` floats apart. Thread safe.
  TraceTally operator()(std::span<const std::uint32_t> vertices, float* rows, std::size_t stride) const;

 private:
  const RayScene& rays_;
  const std::vector<Viewpoint>& viewpoints_;
  Layout layout_;
  OctahedralGrid stored_, sampled_;
  AdaptiveSphere sphere_;
  PrefilteredVisibility prefilter_;
  VisibleFractions fractions_;
};

}  // namespace chiaro
