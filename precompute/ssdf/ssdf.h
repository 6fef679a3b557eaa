#pragma once
/// Spherical signed distance functions from visibility bits (Wang et al. 2009, section 4).

#include <cstdint>
#include <vector>

#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

inline constexpr float kMaxDistance = 1.57079632679f;  ///< radians; also the value where there is no edge at all

/// The edges of what is hidden, as points: normalised midpoints of texels that share an edge and differ in `visible`.
/// For a one-sided vertex only between texels of `above`; below the horizon there is nothing but their mirror images. For a double-sided
/// one the horizon is an edge where front and back see differently: leaving it out would be truer near the horizon (mean error of the
/// visible fraction at sharpness 10: .033 instead of .040 on a helmet), but then the map jumps there, and no linear basis follows a
/// jump (compressed to 48 terms: rms .093 instead of .031 rad, at sharpness 1000 .025 instead of .020).
void boundaryPoints(const OctahedralGrid& grid, const TexelBits& above, const TexelBits& visible, bool doubleSided,
                    std::vector<glm::vec3>& points);

/// Working memory of one thread, so that a vertex costs no allocation.
class SsdfTransform {
 public:
  explicit SsdfTransform(const OctahedralGrid& grid);

  /// Signed angle (radians, in [-pi/2, pi/2]) from each texel centre to the nearest boundary point: exact, positive where visible,
  /// +-pi/2 where no edge is that near. One-sided vertices: texels below the horizon take the distance of their mirror image in it.
  /// distances: #texels, row-major.
  ///
  /// Per 16x16 and then per 4x4 texels only those points are kept that may be nearest to one of them: by the triangle inequality
  /// of chords, those within the smallest chord to the group's centre plus twice the group's radius.
  void operator()(glm::vec3 normal, const AlignedFloats& cosine, const TexelBits& above, const TexelBits& visible, bool doubleSided,
                  float* distances);

 private:
  struct Points {
    AlignedFloats x, y, z;
    std::size_t count = 0;
    std::size_t capacity = 0;
    void reserve(std::size_t points);
  };
  struct Group {
    glm::vec3 center{0.0f};
    float radius = 0.0f;  ///< largest chord to one of its texels
    std::uint32_t firstTile = 0;
    std::uint32_t tileCount = 0;
  };
  void cull(const Points& from, glm::vec3 center, float radius, Points& to);

  const OctahedralGrid& grid_;
  std::vector<Group> groups_;          ///< 16x16 texels
  std::vector<std::uint32_t> tiles_;   ///< tiles of each group
  std::vector<Group> tileBounds_;      ///< 4x4 texels, by tile
  std::vector<glm::vec3> boundary_;
  Points all_, near_, nearest_;
  alignas(64) float folded_[3][16] = {};
  AlignedFloats chord2_;
  std::size_t chordCapacity_ = 0;
};

}  // namespace chiaro
