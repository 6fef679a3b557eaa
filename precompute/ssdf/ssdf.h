#pragma once
/// Spherical signed distance functions from visibility bits (Wang et al. 2009, section 4).

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "precompute/ssdf/face_tree.h"
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
  /// Each of the map's faces is halved down to squares of 8 x 8 texels (FaceTree), on which a point is a plane. A square keeps those of its
  /// parent's points whose plane is above that of the point nearest to its centre anywhere in it.
  void operator()(glm::vec3 normal, bool doubleSided, const TexelBits& above, const TexelBits& visible, const TexelBits& storedAbove,
                  const TexelBits& stored, float* distances);

 private:
  struct Points {
    AlignedFloats x, y, z;
    std::size_t count = 0;  ///< the last one is repeated, up to a multiple of sixteen
    std::size_t capacity = 0;
    void reserve(std::size_t points);
  };
  struct Signal;
  enum class Kind { mixed, seen, hidden };  ///< of all texels of a square, where that is known
  void visit(const FaceTree::Square& square, const OctahedralFace& face, const Points& from, std::size_t depth, Kind kind,
             const Signal& signal);
  void visitLeaf(const FaceTree::Square& square, const OctahedralFace& face, const Points& points, Kind kind, const Signal& signal);
  bool sees(std::size_t texel, const Signal& signal) const;
  /// clear: none of its texels has a boundary point within clear_.
  unsigned seenInTile(std::size_t tile, bool clear, const Signal& signal) const;
  /// A byte for each row.
  void seenInLeaf(const FaceTree::Leaf& leaf, const float* chord2, const Signal& signal, std::uint8_t* seen) const;

  const OctahedralGrid& sampling_;
  const OctahedralGrid& storage_;
  FaceTree tree_;
  float clamp_, clampChord_;
  float slack_;         ///< chord; texels that differ have a boundary point so near to the way between them
  float clear_;         ///< chord; where none of a tile's texels has a boundary point so near, all of them see the same
  std::vector<glm::vec3> boundary_;
  Points all_;                ///< in the frame of one face
  std::vector<Points> kept_;  ///< by depth
  AlignedFloats scratch_;     ///< values above a square's centre, or planes
  std::size_t scratchCapacity_ = 0;
};

}  // namespace chiaro
