#pragma once
/// Triangles where the transfer needs them: a wall of two cannot hold a shadow.

#include <cstddef>
#include <cstdint>
#include <functional>

#include "assets/scene/scene.h"

namespace chiaro {

struct RefineSettings {
  float error = 0.0f;                ///< E, see below, 0..1; 0 leaves the mesh alone
  std::size_t mostVertices = 200000; ///< of the whole scene, never passed
  float leastEdge = 1.0f / 256.0f;   ///< of the scene's diagonal; shorter edges are not split
  float spacing = 1.0f / 32.0f;      ///< of the scene's diagonal; points looked at are at most this far apart
  int resolution = 64;               ///< octahedral texels a side of what is compared; rounded to 32 it takes twice the vertices at E = .03
};

struct RefineReport {
  std::size_t verticesAdded = 0;
  std::size_t trianglesAdded = 0;
  int passes = 0;
  std::size_t edgesTooShort = 0;   ///< left above E because they are shorter than the least edge (only edges made here are looked at)
  std::size_t edgesOverBudget = 0; ///< left above E because the vertices ran out
  double worstError = 0.0;         ///< of the edges left above E
  std::uint64_t raysTraced = 0;
  double seconds = 0.0;
};

/// Splits the edges of `scene` (as prepareScene() makes it) until the transfer interpolated over it is right to E.
///
/// The error at a point compares the sign of the SSDF interpolated from the corners, which is what is shaded with, with what is traced
/// there: w / sqrt(a s), of the solid angles of wrong sign (w), of all directions (a) and of those seen by either (s). It lies between the
/// share of a whole sky, w / a, and the share of the light that comes in, w / s: in a room all of it comes through the windows. At equal
/// vertices it is better than w / a by 0.7 dB in a living room, and the same in the open. All directions are those above the horizon,
/// double-sided all around, without what is behind the point's own triangles, which no vertex on a curved surface sees either.
///
/// An edge's error is the largest at points on it, its midpoint among them. A triangle none of whose edges is above E is looked at inside,
/// on a grid; if that is above E its longest edge counts as such, so a shadow wholly inside a wall is found if it is wider than `spacing`.
///
/// Edges are the same where their positions are, across creases, texture seams and primitives: split on all sides, or none. With an edge the
/// longest of its triangles are split (Rivara 1984): no angle becomes less than half of the smallest it came from. Half-edges would be in
/// the way here: real scenes share edges between three triangles and more.
///
/// Worst first where vertices run out. The same result for any number of threads. Throws Error (usage) for settings out of range.
Scene refineScene(Scene scene, const RefineSettings& settings, int threads, RefineReport& report,
                  const std::function<void(double)>& progress = {});

}  // namespace chiaro
