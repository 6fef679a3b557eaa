#pragma once
/// Tangent frames for normal maps and anisotropy.

#include "assets/scene/scene.h"
#include "precompute/bake.h"

namespace chiaro {

/// A normal map is read in this frame, anisotropy is measured from it.
bool needsTangents(const Material& material, const Primitive& primitive);

/// Gives `primitive` (which must have unit normals) tangents, or takes away those its material does not use. Those of the file
/// are kept, made unit and perpendicular to the normal. Computed ones: per corner the direction of growing U, weighted by the corner's
/// angle, perpendicular to the normal; w says which way the image's upward direction (falling V) goes. Vertices are split where
/// mirrored texture halves meet. Without texture coordinates (anisotropy only) the tangent is a fixed function of the normal.
void makeTangents(Primitive& primitive, const Material& material, RepairReport& report);

}  // namespace chiaro
