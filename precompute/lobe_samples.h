#pragma once
/// Random directions and the rays of a lobe, for measuring errors against traced rays.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace chiaro {

/// Uniform in [0, 1), the same on every standard library.
inline double uniform(std::mt19937& random) { return static_cast<double>(random()) * 0x1p-32; }

/// Uniform over the sphere.
inline glm::dvec3 uniformDirection(std::mt19937& random) {
  const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * std::numbers::pi * uniform(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// The rays of a normalised lobe about any axis: strata of its cumulative distribution, golden angles about the axis.
class LobeRays {
 public:
  LobeRays(double sharpness, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const double u = (static_cast<double>(i) + 0.5) / count;
      const double t = -std::log1p(u * std::expm1(-2.0 * sharpness)) / sharpness;  // 1 - cos
      const double sine = std::sqrt(std::max(t * (2.0 - t), 0.0)), phi = i * 2.39996322972865332;
      about_.emplace_back(sine * std::cos(phi), sine * std::sin(phi), 1.0 - t);
    }
    // Packets of neighbours are traced faster: along a Z curve across the axis.
    const double widest = about_.empty() ? 1.0 : std::max(std::hypot(about_.back().x, about_.back().y), std::sqrt(1.0 / sharpness));
    const auto place = [&](const glm::dvec3& w) {
      constexpr unsigned kCells = 16;
      const auto cell = [&](double x) { return static_cast<unsigned>(std::clamp((0.5 + 0.5 * x / widest) * kCells, 0.0, kCells - 1.0)); };
      unsigned key = w.z < 0.0 ? 1 : 0;
      for (unsigned bit = kCells / 2; bit > 0; bit /= 2) key = 4 * key + ((cell(w.y) & bit) != 0 ? 2 : 0) + ((cell(w.x) & bit) != 0 ? 1 : 0);
      return key;
    };
    std::ranges::stable_sort(about_, {}, place);
  }

  /// turn: radians, about the axis (unit). out: one direction a ray.
  void directions(glm::dvec3 axis, double turn, std::span<glm::vec3> out) const {
    const auto helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const auto x = glm::normalize(glm::cross(helper, axis)), y = glm::cross(axis, x);
    const glm::dmat3 frame(std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x, axis);
    std::transform(about_.begin(), about_.end(), out.begin(), [&](const glm::dvec3& w) { return glm::vec3(frame * w); });
  }

 private:
  std::vector<glm::dvec3> about_;  ///< the axis is z
};

}  // namespace chiaro
