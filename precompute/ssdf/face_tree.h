#pragma once
/// The texels of an octahedral map as a tree of squares for each of its faces. On a face the map is gnomonic: of directions on its plane the
/// product with a point is affine in the map's coordinates, and so the nearest of some points is the topmost of some planes.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "precompute/visibility/octahedral_grid.h"

namespace chiaro {

/// U and V are the distances from the map's two axes, in [0, 1]. In a face's frame a direction on its plane is
/// (U - k, V - k, 1 - U - V) with k = 0 on the four faces about the map's centre and 1 on the outer four.
struct OctahedralFace {
  float signU = 1.0f, signV = 1.0f;
  bool outer = false;

  /// A rotation or reflection.
  glm::vec3 toFrame(glm::vec3 w) const { return outer ? glm::vec3(-signV * w.y, -signU * w.x, w.z) : glm::vec3(signU * w.x, signV * w.y, w.z); }
};

class FaceTree {
 public:
  static constexpr int kSide = 8;  ///< texels a side of a leaf
  static constexpr std::size_t kTexels = std::size_t{kSide * kSide};

  struct Square {
    glm::vec3 center{0.0f};         ///< on the face's plane, in its frame; not unit
    float length = 0.0f;            ///< of the centre
    float half = 0.0f;              ///< of U or V, from the centre to the outermost texels
    float radius = 0.0f;            ///< largest chord from the centre's direction to one of its texels
    std::uint32_t firstChild = 0;   ///< children are consecutive
    std::uint32_t childCount = 0;   ///< none: a leaf
    std::uint32_t leaf = 0;
    std::uint16_t column = 0, row = 0, side = 0;  ///< in the map
    bool whole = false;             ///< all its texels are of this face
  };
  struct Leaf {
    glm::vec3 reference{0.0f};      ///< direction of the centre, in the face's frame
    int column = 0, row = 0;        ///< in the map; may be outside it where the leaf is not whole
    std::array<std::uint8_t, kSide> from{}, to{};  ///< by row of the map: the columns that are of this face
  };

  /// resolution: even.
  explicit FaceTree(int resolution);

  std::array<OctahedralFace, 8> faces;  ///< squares[f] is the root of face f
  std::vector<Square> squares;
  std::vector<Leaf> leaves;
  // By leaf and texel, row by row of the map. The squared chord from a texel's direction q, on the plane at Q, to a point p is
  // excess + scale Q.(reference - p), exactly.
  AlignedFloats excess;  ///< squared chord to the reference
  AlignedFloats scale;   ///< 2 / |Q|

 private:
  struct Place {
    int i, j, side;  ///< texels from the axes
  };
  void add(const OctahedralFace& face, const Place& place);
  std::uint32_t addLeaf(const OctahedralFace& face, const Place& place);
  int half_;
  std::vector<Place> places_;
};

}  // namespace chiaro
