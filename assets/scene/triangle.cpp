#include "assets/scene/triangle.h"

#include <cmath>

namespace chiaro {

glm::dvec3 triangleNormal(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const glm::dvec3 p(a);
  const auto n = glm::cross(glm::dvec3(b) - p, glm::dvec3(c) - p);
  const double length = glm::length(n);
  return length > 0.0 ? n / length : glm::dvec3(0.0);
}

double cornerAngle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const auto u = glm::dvec3(b) - glm::dvec3(a), v = glm::dvec3(c) - glm::dvec3(a);
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace chiaro
