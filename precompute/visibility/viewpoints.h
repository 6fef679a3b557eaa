#pragma once
/// Where to look from: every vertex of a scene, in the order of its primitives, and ray origins that are off the surface.

#include <glm/glm.hpp>
#include <vector>

#include "assets/scene/scene.h"
#include "precompute/embree/ray_scene.h"

namespace chiaro {

struct Viewpoint {
  glm::vec3 normal{0.0f, 0.0f, 1.0f};  ///< unit
  glm::vec3 front{0.0f};               ///< origin of rays with dot(normal, w) > 0
  glm::vec3 back{0.0f};                ///< origin of the others (double-sided only)
  bool doubleSided = false;
};

/// One per vertex of every primitive. An origin is moved off the surface along the normal, and as far towards the middle of the vertex's
/// own triangles: a vertex in a corner, or where a pillar stands on the floor, lies in the plane of another surface, and from there
/// a ray might start behind it.
std::vector<Viewpoint> viewpointsOf(const Scene& scene, const RayScene& rays);

}  // namespace chiaro
