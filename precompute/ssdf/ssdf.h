#pragma once
/// Spherical signed distance functions from visibility bits (Wang et al. 2009, section 4).

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
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

/// The map at one resolution from bits at another or the same. Holds the working memory of one thread, so that a vertex costs no
/// allocation.
class SsdfTransform {
 public:
  /// The grids must outlive this object. clamp: radians, in (0, pi/2]; distances beyond it are not told apart, and cost little.
  SsdfTransform(const OctahedralGrid& sampling, const OctahedralGrid& storage, float clamp = kMaxDistance);

  /// Signed angle (radians) from each texel centre of `storage` to the nearest boundary point of `sampling`: exact, positive where visible,
  /// +-clamp where no edge is nearer. One-sided vertices: texels below the horizon take the distance of their mirror image in it.
  ///
  /// above, visible: at `sampling`. storedAbove, stored: at `storage`; each bit must be that of one of the sampling texels which hold
  /// its centre or touch it (AdaptiveVisibility::at, or the same bits where the resolutions are). Of a one-sided vertex the bits
  /// below the horizon are not read. distances: #texels of `storage`, row-major.
  ///
  /// Groups of texels are halved from a quarter of the map down to 4x4. A group keeps those of its parent's points that may be
  /// nearest to one of its texels. First by the triangle inequality of chords: those within the smallest chord to its centre plus twice its
  /// radius. Then, as the texels lie in the convex hull of the four in its corners (the map's faces are gnomonic) and a point
  /// is nearer than another in a half-space: none that is farther than one other point from all four.
  void operator()(glm::vec3 normal, bool doubleSided, const TexelBits& above, const TexelBits& visible, const TexelBits& storedAbove,
                  const TexelBits& stored, float* distances);

 private:
  struct Points {
    AlignedFloats x, y, z;
    std::size_t count = 0;
    std::size_t capacity = 0;
    void reserve(std::size_t points);
  };
  struct Group {
    glm::vec3 center{0.0f};
    float radius = 0.0f;            ///< largest chord to one of its texels
    std::uint32_t firstTile = 0;    ///< into tiles_
    std::uint32_t tileCount = 0;
    std::uint32_t firstChild = 0;   ///< into groups_; children are consecutive, none if it is one tile
    std::uint32_t childCount = 0;
  };
  struct Tile {
    std::uint32_t number = 0;
    std::uint32_t rowMajor = 0;  ///< of its first texel
  };
  struct Signal;
  void addGroups(const std::vector<std::array<int, 3>>& squares);
  enum class Kind { mixed, seen, hidden };  ///< of all texels of a group, where that is known
  void visit(const Group& group, const Points& from, std::size_t depth, Kind kind, const Signal& signal);
  void visitTile(const Group& group, const Points& points, bool folded, Kind kind, const Signal& signal) const;
  /// No edge is near: one texel says what all of them see.
  bool seesIn(const Group& group, const Signal& signal) const;
  void fill(const Group& group, const Signal& signal) const;
  /// Returns the smallest chord to the centre.
  float keepNear(const Points& from, glm::vec3 center, float radius, float reach, Points& to);
  void keepUndominated(Points& points, const glm::vec3* corners);

  const OctahedralGrid& sampling_;
  const OctahedralGrid& storage_;
  float clamp_, clampChord_;
  float slack_;                        ///< chord; texels that differ have a boundary point so near to the way between them
  std::vector<Group> groups_;
  std::uint32_t rootCount_ = 0;
  std::vector<std::array<glm::vec3, 4>> corners_;  ///< by group; directions of the texels in its corners
  bool convex_;                        ///< all texels of a group lie in the hull of its corners
  std::vector<Tile> tiles_;            ///< of each group
  std::vector<glm::vec3> boundary_;
  Points all_;
  std::vector<Points> kept_;           ///< by depth
  AlignedFloats chord2_;               ///< to the centre, or to four corners one after the other
  std::size_t chordCapacity_ = 0;
};

}  // namespace chiaro
