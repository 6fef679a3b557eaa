#pragma once
/// How far interpolated transfer is from traced transfer, at one point.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// A coarse SSDF: 127 is pi/2; in the order of OctahedralGrid's texels.
using CoarseSsdf = std::vector<std::int8_t>;

/// A corner's SSDF and its weight at a point.
struct WeightedSsdf {
  const CoarseSsdf* ssdf = nullptr;
  float weight = 0.0f;
};

class TransferProbe {
 public:
  TransferProbe(const RayScene& rays, int resolution) : grid_(resolution), rays_(rays) {}

  /// A thread's working memory.
  struct Scratch {
    explicit Scratch(const TransferProbe& probe)
        : cosine(probe.grid_.texelCount), transform(probe.grid_), distances(probe.grid_.texelCount) {}
    AlignedFloats cosine;
    TexelBits above, visible;
    SsdfTransform transform;
    std::vector<float> distances;
    std::uint64_t rays = 0;
  };

  CoarseSsdf trace(const Viewpoint& viewpoint, Scratch& scratch) const;

  /// Share of the solid angle where the interpolated sign is wrong: RefineSettings::error. planes: normals of the triangles the point is on.
  double wrongShare(const Viewpoint& viewpoint, std::span<const glm::vec3> planes, std::span<const WeightedSsdf> corners,
                    Scratch& scratch) const;

 private:
  OctahedralGrid grid_;
  const RayScene& rays_;
};

}  // namespace chiaro
