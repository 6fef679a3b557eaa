#pragma once
/// Rays of a camera through points of its picture.

#include <glm/glm.hpp>

#include "assets/scene/scene.h"

namespace chiaro::reference {

struct ViewRay {
  glm::vec3 origin;
  glm::vec3 direction;  ///< unit
  float near;           ///< along the ray, as far as the camera's planes let it see
  float far;
};

/// The ray through a point of the picture, (0,0) its top left and (1,1) its bottom right corner. aspect: width over height.
ViewRay viewRay(const Camera& camera, double aspect, glm::dvec2 at);

}  // namespace chiaro::reference
