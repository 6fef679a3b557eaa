#include "precompute/report/visibility/visibility_comparison.h"

#include <algorithm>

#include "assets/error.h"
#include "precompute/report/visibility/haar_method.h"
#include "precompute/report/visibility/lobe_truth.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/report/visibility/sh_method.h"

namespace chiaro {
namespace {

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

  const auto stage = [&](const std::string& name) -> std::function<void(double)> {
    return [&progress, name](double done) {
      if (progress) progress(name, done);
    };
  };
  const auto all = points.size(), vertices = result.pointsAtVertices;
  const LobeTruth truth(rays, std::move(points), settings.rays, settings.seed, settings.threads, stage("truth"));
  std::vector<const VisibilityMethod*> asked;
  for (const auto& method : methods) asked.push_back(method.get());
  const auto sums = truth.errorSums(asked, settings.threads, stage("lobes"));
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto bytes = methods[m]->bytes();
    result.methods.push_back({.name = methods[m]->name(),
                              .bytes = bytes,
                              .bytesPerVertex = bytes.perVertex(result.vertices),
                              .atVertices = meanError(sums[m], 0, vertices),
                              .inTriangles = meanError(sums[m], vertices, all)});
  }
  result.truthMean = truth.mean(0, all);
  result.truthNoise = truth.noise(0, all);
  return result;
}

}  // namespace chiaro
