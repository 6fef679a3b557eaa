#pragma once
/// The truth that stored visibility is measured against.

#include <glm/glm.hpp>
#include <span>

#include "precompute/embree/ray_scene.h"

namespace chiaro {

/// Share of `directions` (unit) that leave `origin` above the horizon of `normal` and meet nothing.
double tracedShare(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions);

}  // namespace chiaro
