#include "precompute/report/visibility/visibility_study.h"

#include <algorithm>
#include <numeric>

#include "assets/error.h"

namespace chiaro {
namespace {

const Scene& withSurface(const Scene& scene) {
  if (scene.triangleCount() == 0) throw inputError("scene", "has no triangle with an area", "give a file with a surface in it");
  return scene;
}

std::function<void(double)> stage(const ProgressHandler& progress, const std::string& name) {
  return [&progress, name](double done) {
    if (progress) progress(name, done);
  };
}

std::vector<SurfacePoint> pointsOf(const Scene& scene, const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const VisibilitySettings& settings,
                                   std::size_t& atVertices) {
  auto points = pointsAtVertices(viewpoints, static_cast<std::size_t>(settings.vertices), settings.seed + 1);
  atVertices = points.size();
  for (auto& point : pointsInTriangles(scene, rays, static_cast<std::size_t>(settings.points), settings.seed + 2)) points.push_back(point);
  return points;
}

std::vector<std::size_t> cornersOf(const std::vector<SurfacePoint>& points) {
  std::vector<std::size_t> vertices;
  for (const auto& point : points) vertices.insert(vertices.end(), point.vertices.begin(), point.vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<std::size_t> basisOf(std::size_t vertices, const VisibilitySettings& settings) {
  auto basis = randomSubset(vertices, static_cast<std::size_t>(settings.basisVertices), settings.seed + 3);
  std::sort(basis.begin(), basis.end());
  return basis;
}

}  // namespace

VisibilityStudy::VisibilityStudy(const Scene& scene, const VisibilitySettings& settings, const ProgressHandler& progress)
    : scene_(withSurface(scene)),
      rays_(scene),
      viewpoints_(viewpointsOf(scene, rays_)),
      truth_(rays_, pointsOf(scene, rays_, viewpoints_, settings, atVertices_), settings.rays, settings.seed, settings.threads, stage(progress, "truth")),
      input_{.rays = rays_,
             .viewpoints = viewpoints_,
             .encoded = cornersOf(truth_.points()),
             .basis = basisOf(viewpoints_.size(), settings),
             .resolution = settings.resolution,
             .terms = settings.terms,
             .seed = settings.seed,
             .threads = settings.threads} {}

std::vector<MethodError> VisibilityStudy::errorsOf(const std::vector<const VisibilityMethod*>& methods, const ProgressHandler& progress) const {
  const auto sums = truth_.errorSums(methods, input_.threads, stage(progress, "lobes"));
  std::vector<MethodError> errors;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto bytes = methods[m]->bytes();
    errors.push_back({.name = methods[m]->name(),
                      .bytes = bytes,
                      .bytesPerVertex = bytes.perVertex(scene_.vertexCount()),
                      .atVertices = meanError(sums[m], 0, atVertices_),
                      .inTriangles = meanError(sums[m], atVertices_, truth_.points().size())});
  }
  return errors;
}

std::vector<PointError> VisibilityStudy::worstPoints(const VisibilityMethod& method, std::size_t count, const ProgressHandler& progress) const {
  const auto sums = truth_.errorSums({&method}, input_.threads, stage(progress, "lobes")).front();
  std::vector<PointError> all;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto& point = truth_.points()[i];
    const auto mean = meanError(sums, i, i + 1);
    const auto worst = static_cast<std::size_t>(std::max_element(mean.begin(), mean.end()) - mean.begin());
    const auto corner = static_cast<std::size_t>(std::max_element(point.weights.begin(), point.weights.end()) - point.weights.begin());
    all.push_back({.point = i, .atVertex = i < atVertices_, .vertex = point.vertices[corner], .position = glm::dvec3(point.view.front),
                   .error = std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(mean.size()), .worst = mean[worst], .worstSharpness = kLobeSharpness[worst]});
  }
  std::stable_sort(all.begin(), all.end(), [](const PointError& a, const PointError& b) { return a.error > b.error; });
  all.resize(std::min(count, all.size()));
  return all;
}

VisibilityComparison VisibilityStudy::facts() const {
  const auto all = truth_.points().size();
  return {.vertices = scene_.vertexCount(),
          .triangles = scene_.triangleCount(),
          .pointsAtVertices = atVertices_,
          .pointsInTriangles = all - atVertices_,
          .basisVertices = input_.basis.size(),
          .truthNoise = truth_.noise(0, all),
          .truthMean = truth_.mean(0, all),
          .methods = {}};
}

}  // namespace chiaro
