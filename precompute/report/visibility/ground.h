#pragma once
/// A floor for scans, which come without one.

#include "assets/scene/scene.h"

namespace chiaro {

/// Adds a square of 40 x 40 vertices, three diagonals of the scene wide, facing up, a thousandth of a diagonal under its lowest vertex
/// (touching it, rays from there would start on both sides). Nothing for an empty scene.
void addGround(Scene& scene);

}  // namespace chiaro
