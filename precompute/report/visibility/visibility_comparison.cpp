#include "precompute/report/visibility/visibility_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "assets/error.h"
#include "precompute/parallel.h"
#include "precompute/random_directions.h"
#include "precompute/report/visibility/haar_method.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/report/visibility/sh_method.h"
#include "precompute/traced_share.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::size_t kIntegrationDirections = 2048;  // where a stored map is integrated against a lobe: error of a step .001

using Methods = std::vector<std::unique_ptr<VisibilityMethod>>;

/// A lobe in two patterns, one for the truth and one for the methods, so that no method shares the truth's own error.
struct Patterns {
  LobePattern truth, methods;
};

/// Sums over the axes of one point.
struct PointSums {
  ErrorBySharpness truth{}, noise{};
  std::vector<ErrorBySharpness> error;  ///< of each method
};

glm::dvec3 directionAbove(glm::vec3 normal, std::mt19937& random) {
  const auto w = uniformDirection(random);
  return glm::dot(w, glm::dvec3(normal)) < 0.0 ? -w : w;
}

PointSums measure(const RayScene& rays, const Methods& methods, const SurfacePoint& point, const std::vector<Patterns>& patterns,
                  std::mt19937 random) {
  PointSums sums;
  sums.error.resize(methods.size());
  std::vector<LobeFraction> fractions;
  for (const auto& method : methods) fractions.push_back(method->at(point));
  std::vector<glm::vec3> directions;
  Lobe lobe;
  for (std::size_t a = 0; a < kAxes; ++a) {
    lobe.axis = directionAbove(point.view.normal, random);
    for (std::size_t s = 0; s < patterns.size(); ++s) {
      const auto turn = [&] { return 2.0 * std::numbers::pi * uniform(random); };
      double halves[2] = {};
      for (double& half : halves) {
        patterns[s].truth.directions(lobe.axis, turn(), directions);
        half = tracedShare(rays, point.view.front, point.view.normal, directions);
      }
      const double truth = 0.5 * (halves[0] + halves[1]);
      sums.truth[s] += truth;
      sums.noise[s] += 0.5 * std::abs(halves[0] - halves[1]);
      lobe.sharpness = patterns[s].methods.sharpness();
      patterns[s].methods.directions(lobe.axis, turn(), lobe.directions);
      for (std::size_t m = 0; m < methods.size(); ++m) {
        const double estimate = fractions[m](lobe);
        sums.error[m][s] += std::abs(lobe64::clampReal(estimate, 0.0, 1.0) - truth);
      }
    }
  }
  return sums;
}

ErrorBySharpness scaled(const ErrorBySharpness& sum, double count) {
  ErrorBySharpness mean{};
  for (std::size_t s = 0; s < sum.size(); ++s) mean[s] = count > 0.0 ? sum[s] / count : std::numeric_limits<double>::quiet_NaN();
  return mean;
}

void add(ErrorBySharpness& sum, const ErrorBySharpness& more) {
  for (std::size_t s = 0; s < sum.size(); ++s) sum[s] += more[s];
}

std::vector<std::size_t> cornersOf(const std::vector<SurfacePoint>& points) {
  std::vector<std::size_t> vertices;
  for (const auto& point : points) vertices.insert(vertices.end(), point.vertices.begin(), point.vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

std::vector<std::unique_ptr<VisibilityMethod>> baselineMethods(const VisibilityInput& input) {
  auto methods = makeShMethods(input, {5, 7, 10});
  for (auto& method : makeHaarMethods(input, {24, 48, 96})) methods.push_back(std::move(method));
  const OctahedralGrid grid(input.resolution);
  const TracedVertices traced(input, grid);
  for (const auto& kind : {binaryVisibility(), ssdfWithHorizon(), ssdfOfOccluders()})
    methods.push_back(makePcaMethod(input, traced, kind));
  methods.push_back(makeUncompressedMethod(input, traced, ssdfOfOccluders()));
  methods.push_back(makeUnoccludedMethod());
  return methods;
}

VisibilityComparison compareVisibility(const Scene& scene, const MethodMaker& makeMethods, const VisibilitySettings& settings,
                                       const ProgressHandler& progress) {
  VisibilityComparison result;
  result.vertices = scene.vertexCount();
  result.triangles = scene.triangleCount();
  if (result.triangles == 0) throw inputError("scene", "has no triangle with an area", "give a file with a surface in it");
  if (progress) progress("methods", 0.0);
  const RayScene rays(scene);
  const auto viewpoints = viewpointsOf(scene, rays);
  auto points = pointsAtVertices(viewpoints, static_cast<std::size_t>(settings.vertices), settings.seed + 1);
  result.pointsAtVertices = points.size();
  for (auto& point : pointsInTriangles(scene, rays, static_cast<std::size_t>(settings.points), settings.seed + 2))
    points.push_back(point);
  result.pointsInTriangles = points.size() - result.pointsAtVertices;

  VisibilityInput input{
      .rays = rays,
      .viewpoints = viewpoints,
      .encoded = cornersOf(points),
      .basis = randomSubset(viewpoints.size(), static_cast<std::size_t>(settings.basisVertices), settings.seed + 3),
      .resolution = settings.resolution,
      .terms = settings.terms,
      .seed = settings.seed,
      .threads = settings.threads};
  std::sort(input.basis.begin(), input.basis.end());
  result.basisVertices = input.basis.size();
  const auto methods = makeMethods(input);

  std::vector<Patterns> patterns;
  for (const double sharpness : kLobeSharpness)
    patterns.push_back({{sharpness, static_cast<std::size_t>(settings.rays) / 2}, {sharpness, kIntegrationDirections}});
  std::vector<PointSums> sums(points.size());
  const std::function<void(double)> measured = [&](double done) {
    if (progress) progress("lobes", done);
  };
  StepCounter steps(points.size(), measured);
  parallelBlocks(settings.threads, points.size(), [&](std::size_t i) {
    const auto index = static_cast<std::uint32_t>(i);
    sums[i] = measure(rays, methods, points[i], patterns, std::mt19937(settings.seed ^ (0x9e3779b9u * (index + 1u))));
    steps.add();
  });

  const auto axes = static_cast<double>(kAxes);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    ErrorBySharpness vertices{}, triangles{};
    for (std::size_t i = 0; i < points.size(); ++i) add(i < result.pointsAtVertices ? vertices : triangles, sums[i].error[m]);
    const auto bytes = methods[m]->bytes();
    result.methods.push_back({.name = methods[m]->name(),
                              .bytes = bytes,
                              .bytesPerVertex = bytes.perVertex(result.vertices),
                              .atVertices = scaled(vertices, axes * static_cast<double>(result.pointsAtVertices)),
                              .inTriangles = scaled(triangles, axes * static_cast<double>(result.pointsInTriangles))});
  }
  for (const auto& sum : sums) {
    add(result.truthMean, sum.truth);
    add(result.truthNoise, sum.noise);
  }
  result.truthMean = scaled(result.truthMean, axes * static_cast<double>(points.size()));
  result.truthNoise = scaled(result.truthNoise, axes * static_cast<double>(points.size()));
  return result;
}

}  // namespace chiaro
