#include "precompute/report/visibility/product_error.h"

#include <numbers>

#include "precompute/parallel.h"
#include "precompute/random_directions.h"
#include "precompute/traced_share.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr int kAxes = 16;

struct Sums {
  std::vector<double> innerError, vectorError;
};

}  // namespace

const std::vector<double>& productSharpness() {
  static const std::vector<double> all = [] {
    std::vector<double> values;
    for (double sharpness = 1.0; sharpness <= 4096.0; sharpness *= 2.0) values.push_back(sharpness);
    return values;
  }();
  return all;
}

std::vector<ProductError> productErrors(const RayScene& rays, const std::vector<SurfacePoint>& points, const std::vector<const VisibilityMethod*>& methods, int raysPerLobe, std::uint32_t seed,
                                        int threads, const std::function<void(double)>& progress) {
  const auto& sharpness = productSharpness();
  const auto count = sharpness.size(), ways = methods.size() + 1;
  std::vector<LobePattern> patterns;
  for (const double s : sharpness) patterns.emplace_back(s, static_cast<std::size_t>(raysPerLobe));
  patterns.emplace_back(2.0 * sharpness.back(), static_cast<std::size_t>(raysPerLobe));
  std::vector<std::vector<Sums>> sums(points.size(), std::vector<Sums>(ways, {std::vector<double>(count), std::vector<double>(count)}));
  std::vector<Sums> truths(points.size(), {std::vector<double>(count), std::vector<double>(count)});  // of the squares of both products
  StepCounter steps(points.size(), progress);
  parallelBlocks(threads, points.size(), [&](std::size_t i) {
    std::mt19937 random(seed ^ (0x85ebca6bu * (static_cast<std::uint32_t>(i) + 1u)));
    const auto& view = points[i].view;
    std::vector<LobeFraction> fractions;
    for (const auto* method : methods) fractions.push_back(method->at(points[i]));
    std::vector<glm::vec3> directions;
    std::vector<double> seen(patterns.size());
    for (int a = 0; a < kAxes; ++a) {
      auto axis = uniformDirection(random);
      if (glm::dot(axis, glm::dvec3(view.normal)) < 0.0) axis = -axis;
      for (std::size_t s = 0; s < patterns.size(); ++s) {
        patterns[s].directions(axis, 2.0 * std::numbers::pi * uniform(random), directions);
        seen[s] = tracedShare(rays, view.front, view.normal, directions);
      }
      for (std::size_t s = 0; s < count; ++s) {
        // G^2 is a Gaussian of twice the sharpness, so over its integral |G V - r G|^2 = (1 - 2 r) seen + r^2.
        const double squared = seen[s + 1];
        truths[i].innerError[s] += seen[s] * seen[s];
        truths[i].vectorError[s] += squared;
        for (std::size_t m = 0; m < ways; ++m) {
          const double share = m < methods.size() ? lobe64::clampReal(fractions[m]({.axis = axis, .sharpness = sharpness[s]}), 0.0, 1.0) : seen[s];
          sums[i][m].innerError[s] += (share - seen[s]) * (share - seen[s]);
          sums[i][m].vectorError[s] += (1.0 - 2.0 * share) * squared + share * share;
        }
      }
    }
    steps.add();
  });
  std::vector<ProductError> errors(ways, {std::vector<double>(count), std::vector<double>(count)});
  for (std::size_t s = 0; s < count; ++s) {
    double inner = 0.0, vector = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      inner += truths[i].innerError[s];
      vector += truths[i].vectorError[s];
      for (std::size_t m = 0; m < ways; ++m) {
        errors[m].inner[s] += sums[i][m].innerError[s];
        errors[m].vector[s] += sums[i][m].vectorError[s];
      }
    }
    for (auto& error : errors) {
      error.inner[s] /= inner;
      error.vector[s] /= vector;
    }
  }
  return errors;
}

}  // namespace chiaro
