#pragma once
/// The truth that stored visibility is measured against.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "precompute/embree/ray_scene.h"

namespace chiaro {

/// Share of `directions` (unit) that leave `origin` above the horizon of `normal` and meet nothing.
double tracedShare(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions);

/// Each of them by itself: 1 where it is free.
void tracedDirections(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions, std::vector<std::uint8_t>& free);

}  // namespace chiaro
