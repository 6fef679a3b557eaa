#pragma once
/// Random directions and the rays of a lobe, for measuring errors against traced rays.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

namespace chiaro {

/// Uniform in [0, 1), the same on every standard library.
inline double uniform(std::mt19937& random) { return static_cast<double>(random()) * 0x1p-32; }

/// Uniform over the sphere.
inline glm::dvec3 uniformDirection(std::mt19937& random) {
  const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * std::numbers::pi * uniform(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Ray i of `count` of a normalised lobe (inverse of its cumulative distribution in strata, golden angle about the axis).
inline glm::vec3 lobeDirection(glm::dvec3 axis, double sharpness, std::uint32_t i, std::uint32_t count, double turn) {
  const double u = (static_cast<double>(i) + 0.5) / count;
  const double t = -std::log1p(u * std::expm1(-2.0 * sharpness)) / sharpness;  // 1 - cos
  const double sine = std::sqrt(std::max(t * (2.0 - t), 0.0)), phi = turn + i * 2.39996322972865332;
  const auto helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const auto x = glm::normalize(glm::cross(helper, axis)), y = glm::cross(axis, x);
  return glm::vec3(glm::normalize((1.0 - t) * axis + sine * (std::cos(phi) * x + std::sin(phi) * y)));
}

}  // namespace chiaro
