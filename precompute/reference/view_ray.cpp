#include "precompute/reference/view_ray.h"

#include <cmath>

namespace chiaro::reference {

ViewRay viewRay(const Camera& camera, double aspect, glm::dvec2 at) {
  const glm::dvec2 screen((2.0 * at.x - 1.0) * aspect, 1.0 - 2.0 * at.y);
  const glm::dmat4 worldFromCamera(camera.worldFromCamera);
  glm::dvec3 origin(0.0);
  glm::dvec3 direction(0.0, 0.0, -1.0);
  if (camera.perspective) {
    direction = glm::normalize(glm::dvec3(std::tan(0.5 * static_cast<double>(camera.verticalFov)) * screen, -1.0));
  } else {
    origin = glm::dvec3(static_cast<double>(camera.verticalExtent) * screen, 0.0);
  }
  const double perDepth = -1.0 / direction.z;  // the planes are at depths, a ray measures along itself
  ViewRay ray;
  ray.origin = glm::vec3(glm::dvec3(worldFromCamera * glm::dvec4(origin, 1.0)));
  ray.direction = glm::vec3(glm::normalize(glm::dvec3(worldFromCamera * glm::dvec4(direction, 0.0))));
  ray.near = static_cast<float>(static_cast<double>(camera.nearPlane) * perDepth);
  ray.far = static_cast<float>(static_cast<double>(camera.farPlane) * perDepth);
  return ray;
}

}  // namespace chiaro::reference
