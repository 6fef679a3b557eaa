#pragma once
/// Vertex normals: made where the file has none, mended where it has bad ones.

#include "assets/scene/scene.h"
#include "assets/scene/triangle.h"
#include "precompute/bake.h"
#include "precompute/mesh/half_edge.h"

namespace chiaro {

/// For a primitive without normals. Corners of one vertex that are joined across edges bent by at most `creaseAngle`
/// (radians) share a normal: the mean of their triangles' normals weighted by the corners' angles (Thuermer and Wuethrich 1998).
/// Vertices are split where corners are not joined; tangents, meaningless without normals, are dropped.
void computeNormals(Primitive& primitive, const HalfEdges& halfEdges, float creaseAngle, RepairReport& report);

/// For a primitive with normals: makes them unit. A normal off unit length by more than 1e-3 counts as repaired; one without
/// direction is replaced by the angle-weighted mean of its triangles' normals.
void repairNormals(Primitive& primitive, RepairReport& report);

}  // namespace chiaro
