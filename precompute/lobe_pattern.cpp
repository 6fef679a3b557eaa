#include "precompute/lobe_pattern.h"

#include <algorithm>
#include <cmath>

#include "precompute/z_curve.h"

namespace chiaro {

LobePattern::LobePattern(double sharpness, std::size_t count) : sharpness_(sharpness) {
  constexpr double kGoldenAngle = 2.39996322972865332;
  double widest = std::sqrt(1.0 / sharpness);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double t = -std::log1p(u * std::expm1(-2.0 * sharpness)) / sharpness;
    const double sine = std::sqrt(std::max(t * (2.0 - t), 0.0)), phi = static_cast<double>(i) * kGoldenAngle;
    local_.emplace_back(sine * std::cos(phi), sine * std::sin(phi), t);
    widest = std::max(widest, sine);
  }
  std::ranges::stable_sort(local_, {}, [&](const glm::dvec3& w) {
    constexpr unsigned kCells = 16;
    const auto cell = [&](double x) { return static_cast<unsigned>(std::clamp((0.5 + 0.5 * x / widest) * kCells, 0.0, kCells - 1.0)); };
    return zCurve(cell(w.x), cell(w.y), kCells) + (w.z > 1.0 ? kCells * kCells : 0);  // those behind last
  });
}

void LobePattern::directions(glm::dvec3 axis, double turn, std::vector<glm::vec3>& out) const {
  const auto helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const auto u = glm::normalize(glm::cross(helper, axis)), v = glm::cross(axis, u);
  const auto x = std::cos(turn) * u + std::sin(turn) * v, y = glm::cross(axis, x);
  out.clear();
  for (const auto& p : local_) out.emplace_back(glm::normalize((1.0 - p.z) * axis + p.x * x + p.y * y));
}

}  // namespace chiaro
