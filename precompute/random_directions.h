#pragma once
/// Random numbers and directions, the same on every standard library.

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

namespace chiaro {

/// Uniform in [0, 1).
inline double uniform(std::mt19937& random) { return static_cast<double>(random()) * 0x1p-32; }

/// Uniform over the sphere.
inline glm::dvec3 uniformDirection(std::mt19937& random) {
  const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * std::numbers::pi * uniform(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace chiaro
