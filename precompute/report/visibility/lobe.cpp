#include "precompute/report/visibility/lobe.h"

#include <algorithm>
#include <cmath>

namespace chiaro {

LobePattern::LobePattern(double sharpness, std::size_t count) : sharpness_(sharpness) {
  constexpr double kGoldenAngle = 2.39996322972865332;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double t = -std::log1p(u * std::expm1(-2.0 * sharpness)) / sharpness;
    const double sine = std::sqrt(std::max(t * (2.0 - t), 0.0)), phi = static_cast<double>(i) * kGoldenAngle;
    local_.emplace_back(sine * std::cos(phi), sine * std::sin(phi), t);
  }
}

void LobePattern::directions(glm::dvec3 axis, double turn, std::vector<glm::vec3>& out) const {
  const auto helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const auto u = glm::normalize(glm::cross(helper, axis)), v = glm::cross(axis, u);
  const auto x = std::cos(turn) * u + std::sin(turn) * v, y = glm::cross(axis, x);
  out.clear();
  for (const auto& p : local_) out.emplace_back(glm::normalize((1.0 - p.z) * axis + p.x * x + p.y * y));
}

}  // namespace chiaro
