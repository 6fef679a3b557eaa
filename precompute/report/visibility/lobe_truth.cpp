#include "precompute/report/visibility/lobe_truth.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "precompute/parallel.h"
#include "precompute/random_directions.h"
#include "precompute/traced_share.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::size_t kIntegrationDirections = 2048;  // where a stored map is integrated against a lobe: error of a step .001

std::vector<LobePattern> patterns(std::size_t count) {
  std::vector<LobePattern> all;
  for (const double sharpness : kLobeSharpness) all.emplace_back(sharpness, count);
  return all;
}

glm::dvec3 directionAbove(glm::vec3 normal, std::mt19937& random) {
  const auto w = uniformDirection(random);
  return glm::dot(w, glm::dvec3(normal)) < 0.0 ? -w : w;
}

}  // namespace

LobeTruth::LobeTruth(const RayScene& rays, std::vector<SurfacePoint> points, int raysPerLobe, std::uint32_t seed, int threads,
                     const std::function<void(double)>& progress)
    : points_(std::move(points)), axes_(points_.size() * kAxes) {
  const auto traced = patterns(static_cast<std::size_t>(raysPerLobe) / 2);
  StepCounter steps(points_.size(), progress);
  parallelBlocks(threads, points_.size(), [&](std::size_t i) {
    std::mt19937 random(seed ^ (0x9e3779b9u * (static_cast<std::uint32_t>(i) + 1u)));
    const auto turn = [&] { return 2.0 * std::numbers::pi * uniform(random); };
    std::vector<glm::vec3> directions;
    const auto& view = points_[i].view;
    for (std::size_t a = 0; a < kAxes; ++a) {
      Axis& axis = axes_[i * kAxes + a];
      axis.axis = directionAbove(view.normal, random);
      for (std::size_t s = 0; s < traced.size(); ++s) {
        double halves[2] = {};
        for (double& half : halves) {
          traced[s].directions(axis.axis, turn(), directions);
          half = tracedShare(rays, view.front, view.normal, directions);
        }
        axis.truth[s] = 0.5 * (halves[0] + halves[1]);
        axis.noise[s] = 0.5 * std::abs(halves[0] - halves[1]);
        axis.turn[s] = turn();
      }
    }
    steps.add();
  });
}

ErrorBySharpness LobeTruth::meanOf(ErrorBySharpness Axis::*value, std::size_t first, std::size_t last) const {
  std::vector<ErrorBySharpness> sums(last - first);
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t a = 0; a < kAxes; ++a)
      for (std::size_t s = 0; s < kLobeSharpness.size(); ++s) sums[i - first][s] += (axes_[i * kAxes + a].*value)[s];
  return meanError(sums, 0, sums.size());
}

ErrorBySharpness LobeTruth::mean(std::size_t first, std::size_t last) const { return meanOf(&Axis::truth, first, last); }
ErrorBySharpness LobeTruth::noise(std::size_t first, std::size_t last) const { return meanOf(&Axis::noise, first, last); }

std::vector<std::vector<ErrorBySharpness>> LobeTruth::errorSums(const std::vector<const VisibilityMethod*>& methods, int threads,
                                                                const std::function<void(double)>& progress) const {
  // Not the truth's pattern, so that no method shares the truth's own error.
  const auto integrated = patterns(kIntegrationDirections);
  std::vector<std::vector<ErrorBySharpness>> sums(methods.size(), std::vector<ErrorBySharpness>(points_.size()));
  StepCounter steps(points_.size(), progress);
  parallelBlocks(threads, points_.size(), [&](std::size_t i) {
    std::vector<LobeFraction> fractions;
    for (const auto* method : methods) fractions.push_back(method->at(points_[i]));
    Lobe lobe;
    for (std::size_t a = 0; a < kAxes; ++a) {
      const Axis& axis = axes_[i * kAxes + a];
      lobe.axis = axis.axis;
      for (std::size_t s = 0; s < integrated.size(); ++s) {
        lobe.sharpness = integrated[s].sharpness();
        integrated[s].directions(lobe.axis, axis.turn[s], lobe.directions);
        for (std::size_t m = 0; m < methods.size(); ++m)
          sums[m][i][s] += std::abs(lobe64::clampReal(fractions[m](lobe), 0.0, 1.0) - axis.truth[s]);
      }
    }
    steps.add();
  });
  return sums;
}

ErrorBySharpness meanError(const std::vector<ErrorBySharpness>& sums, std::size_t first, std::size_t last) {
  ErrorBySharpness mean{};
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t s = 0; s < mean.size(); ++s) mean[s] += sums[i][s];
  const auto count = static_cast<double>((last - first) * LobeTruth::kAxes);
  for (double& value : mean) value = count > 0.0 ? value / count : std::numeric_limits<double>::quiet_NaN();
  return mean;
}

}  // namespace chiaro
