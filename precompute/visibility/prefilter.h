#pragma once
/// Prefiltered visibility: how much of a normalised SG lobe a vertex sees, for every direction of a small map, per sharpness.

#include <cstdint>
#include <memory>
#include <vector>

#include "assets/transfer/transfer.h"
#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// For each level and each texel p of its octahedral map, over the directions w on p's side of the vertex's horizon:
///
///   v(p) = integral G(w; p, sharpness) V(w) dw  /  the same without V
///
/// so that an unoccluded vertex has 1 everywhere. A lobe of which less than a thirtieth is above a one-sided vertex's horizon takes the
/// value of its mirror image in the horizon. The traced map is first averaged down to texels that the level's lobe cannot tell apart.
class PrefilteredVisibility {
 public:
  static constexpr std::size_t kBatch = 16;  ///< vertices that are filtered together

  PrefilteredVisibility(const OctahedralGrid& grid, const std::vector<VisibilityLevel>& levels);

  /// Floats a vertex: the levels' maps, one behind the other, row-major.
  std::size_t size() const { return size_; }

  /// What one call works in; one a thread.
  struct Scratch {
    std::vector<AlignedFloats> mass;  ///< by grid of the pyramid: #texels by kBatch
    AlignedFloats seen, all;          ///< #size by kBatch
    std::vector<std::uint8_t> wanted; ///< by texel of the output: what of the two has to be summed
  };
  Scratch scratch() const;

  /// Up to kBatch vertices, fastest with like normals. viewpoints, above, visible: `count` each; out: where each vertex's values go.
  void operator()(std::size_t count, const Viewpoint* viewpoints, const TexelBits* above, const TexelBits* visible, float* const* out,
                  Scratch& scratch) const;

 private:
  struct Grid {
    int resolution;
    std::vector<glm::vec3> direction;  ///< row-major
    std::vector<float> solidAngle;
  };
  struct Level {
    float sharpness;
    int resolution;
    std::size_t grid;                     ///< index into grids_
    std::size_t first;                    ///< of its texels in the output
    std::vector<glm::vec3> axis;
    std::vector<std::uint32_t> firstTap;  ///< #texels + 1
    std::vector<std::uint32_t> tapTexel;
    std::vector<float> tapWeight;         ///< SG, normalised over the sphere
    std::vector<float> shareAbove;        ///< table over dot(normal, axis) in [-1, 1]
    float clearOfHorizon = 2.0f;          ///< no tap reaches the horizon where dot(normal, axis) is above this
    float leastAbove = -1.0f;             ///< below this dot(normal, axis) too little is above the horizon
  };
  /// visible: null for all of the side.
  void fillMass(std::size_t count, const Viewpoint* viewpoints, const TexelBits* above, const TexelBits* visible, bool back, Scratch& scratch) const;
  void sumCoarser(Scratch& scratch) const;
  void markWanted(std::size_t count, const Viewpoint* viewpoints, bool back, Scratch& scratch) const;
  /// Texels of which `wanted` has the bit `which`.
  void gather(const Scratch& scratch, std::uint8_t which, AlignedFloats& sums) const;
  void store(const Viewpoint& viewpoint, bool back, std::size_t lane, const Scratch& scratch, float* out) const;
  void mirrorHidden(const Viewpoint& viewpoint, float* out) const;

  const OctahedralGrid& source_;
  std::vector<Grid> grids_;                      ///< finest first, each half the one before
  std::vector<std::uint32_t> finestOf_;          ///< texel of the source grid -> texel of grids_[0]
  float share_ = 1.0f;                           ///< of a grids_[0] texel that one source texel is
  std::vector<Level> levels_;
  std::vector<float> whole_;                     ///< by texel of the output: `all` where the horizon is far
  std::size_t size_ = 0;
};

}  // namespace chiaro
