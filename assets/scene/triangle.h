#pragma once
/// Measures of a triangle, in double whatever its size.

#include <glm/glm.hpp>

namespace chiaro {

/// Unit normal of a triangle; zero when it has no area.
glm::dvec3 triangleNormal(glm::vec3 a, glm::vec3 b, glm::vec3 c);

/// Angle (radians) of triangle (a, b, c) at a.
double cornerAngle(glm::vec3 a, glm::vec3 b, glm::vec3 c);

}  // namespace chiaro
