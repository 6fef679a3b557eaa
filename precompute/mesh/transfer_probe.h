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
        : cosine(probe.grid_.texelCount), transform(probe.grid_, probe.grid_), distances(probe.grid_.texelCount) {}
    AlignedFloats cosine;
    TexelBits above, visible;
    SsdfTransform transform;
    std::vector<float> distances;
    std::uint64_t rays = 0;
  };

  CoarseSsdf trace(const Viewpoint& viewpoint, Scratch& scratch) const;

  /// RefineSettings::error of interpolation at a point. planes: normals of the triangles it is on. A quarter of the directions is enough
  /// where the error among them is no more than `enough`.
  double error(const Viewpoint& viewpoint, std::span<const glm::vec3> planes, std::span<const WeightedSsdf> corners, double enough,
                    Scratch& scratch) const;

 private:
  bool inPart(std::size_t tile, std::size_t part) const;

  OctahedralGrid grid_;
  const RayScene& rays_;
};

}  // namespace chiaro
