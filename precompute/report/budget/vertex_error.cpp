#include "precompute/report/budget/vertex_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "precompute/parallel.h"
#include "precompute/random_directions.h"
#include "precompute/report/visibility/lobe_sharpness.h"
#include "precompute/report/visibility/transfer_method.h"
#include "precompute/traced_share.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr float kApart = 0.02f;  // of the diagonal
constexpr std::size_t kBlock = 64;

struct Place {
  std::size_t primitive, vertex;
};

Place placeOf(const Scene& scene, std::size_t vertex) {
  std::size_t p = 0;
  while (vertex >= scene.primitives[p].positions.size()) vertex -= scene.primitives[p++].positions.size();
  return {p, vertex};
}

}  // namespace

VertexErrors vertexErrors(const Scene& scene, const Transfer& transfer, const VertexErrorSettings& settings, const ProgressHandler& progress) {
  const RayScene rays(scene);
  const auto viewpoints = viewpointsOf(scene, rays);
  const auto method = makeTransferMethod(transfer);
  std::vector<LobePattern> patterns;
  for (const double sharpness : kLobeSharpness) patterns.emplace_back(sharpness, static_cast<std::size_t>(settings.raysPerLobe));
  VertexErrors result{.error = std::vector<float>(viewpoints.size())};
  const std::function<void(double)> shown = [&](double done) {
    if (progress) progress("every vertex", done);
  };
  const auto blocks = (viewpoints.size() + kBlock - 1) / kBlock;
  StepCounter steps(blocks, shown);
  parallelBlocks(settings.threads, blocks, [&](std::size_t block) {
    std::vector<glm::vec3> directions;
    for (auto v = block * kBlock; v < std::min((block + 1) * kBlock, viewpoints.size()); ++v) {
      std::mt19937 random(settings.seed ^ (0xc2b2ae35u * (static_cast<std::uint32_t>(v) + 1u)));
      const SurfacePoint point{.vertices = {v, v, v}, .view = viewpoints[v]};
      const auto fraction = method->at(point);
      double sum = 0.0;
      for (int a = 0; a < settings.axes; ++a) {
        auto axis = uniformDirection(random);
        if (glm::dot(axis, glm::dvec3(point.view.normal)) < 0.0) axis = -axis;
        for (const auto& pattern : patterns) {
          pattern.directions(axis, 2.0 * std::numbers::pi * uniform(random), directions);
          const double estimate = lobe64::clampReal(fraction({.axis = axis, .sharpness = pattern.sharpness()}), 0.0, 1.0);
          sum += std::abs(estimate - tracedShare(rays, point.view.front, point.view.normal, directions));
        }
      }
      result.error[v] = static_cast<float>(sum / static_cast<double>(settings.axes * static_cast<int>(patterns.size())));
    }
    steps.add();
  });
  auto sorted = result.error;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) { return static_cast<double>(sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]); };
  result.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
  result.median = at(0.5);
  result.percentile95 = at(0.95);
  return result;
}

std::vector<WorstVertex> worstVertices(const Scene& scene, const VertexErrors& errors, std::size_t count) {
  std::vector<std::size_t> order(errors.error.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors.error[a] > errors.error[b]; });
  const float apart = kApart * boundsOf(scene).diagonal();
  std::vector<WorstVertex> worst;
  for (const auto v : order) {
    if (worst.size() == count) break;
    const auto [p, vertex] = placeOf(scene, v);
    const auto& primitive = scene.primitives[p];
    const auto position = primitive.positions[vertex];
    if (std::any_of(worst.begin(), worst.end(), [&](const WorstVertex& other) { return glm::distance(other.position, position) < apart; })) continue;
    const auto& name = scene.meshNames[static_cast<std::size_t>(primitive.mesh)];
    worst.push_back({.vertex = v, .mesh = name.empty() ? "mesh " + std::to_string(primitive.mesh) : name, .position = position, .normal = primitive.normals[vertex],
                     .error = static_cast<double>(errors.error[v])});
  }
  return worst;
}

}  // namespace chiaro
