#pragma once
/// Normals that a file leaves out or leaves zero.

#include "assets/scene/scene.h"

namespace chiaro {

/// Gives every triangle its own three vertices and its geometric normal: what glTF 2.0 (3.7.2.1) asks of a primitive without
/// normals. Tangents are dropped, as they need a normal. A triangle without area gets +Y.
void makeFlat(Primitive& primitive);

/// Scales normals to unit length; one too short to have a direction becomes the area-weighted mean of its triangles' normals (+Y when
/// that is zero too). Already-unit normals keep their bits. Returns the number of those replaced.
std::size_t normalizeNormals(Primitive& primitive);

}  // namespace chiaro
