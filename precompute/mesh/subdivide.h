#pragma once
/// The edges of a scene by position, and splitting them without cracks.

#include <cstdint>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// One triangle's use of an edge.
struct EdgeSide {
  std::uint32_t a = 0, b = 0;      ///< vertices in the primitive, a < b
  std::uint32_t primitive = 0;
  std::uint32_t triangle = 0;      ///< of the scene: counted through its primitives
  std::uint32_t firstIndex = 0;    ///< of the triangle, in the primitive's indices
  std::uint32_t corner = 0;        ///< 0..2: the edge runs from here to the next corner

  bool sameWing(const EdgeSide& other) const { return primitive == other.primitive && a == other.a && b == other.b; }
};

/// Edges between positions. Its sides are sorted, so that those of one wing (one pair of vertices) are neighbours; creases, texture seams
/// and borders of primitives give an edge several wings.
struct EdgeTable {
  explicit EdgeTable(const Scene& scene);

  std::size_t size() const { return length.size(); }
  /// Edge of `triangle` that is split with any other of it. Equal lengths are told apart the same way from all sides.
  std::uint32_t longestOf(std::uint32_t triangle) const;

  std::vector<EdgeSide> sides;
  std::vector<std::uint32_t> firstSide;     ///< #edges + 1
  std::vector<std::uint32_t> wings;         ///< #edges; vertices that splitting it adds
  std::vector<double> length;               ///< #edges, metres
  std::vector<std::uint32_t> edgeOfCorner;  ///< 3 * #triangles
};

/// Splits the edges of `table` that are `marked`, with them every triangle they bound. For no triangle may an edge be marked and the
/// longest not. New vertices lie at the middle of their edge and follow the old ones of their primitive.
void subdivide(Scene& scene, const EdgeTable& table, const std::vector<bool>& marked);

}  // namespace chiaro
