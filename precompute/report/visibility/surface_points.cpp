#include "precompute/report/visibility/surface_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "precompute/random_directions.h"

namespace chiaro {
namespace {

struct Triangle {
  const Primitive* primitive;
  std::size_t firstVertex;  ///< of the primitive, in the whole scene
  std::size_t firstIndex;
};

glm::dvec3 corner(const Triangle& triangle, std::size_t c) {
  return triangle.primitive->positions[triangle.primitive->indices[triangle.firstIndex + c]];
}

/// Area-uniform barycentric weights.
std::array<float, 3> randomWeights(std::mt19937& random) {
  const double root = std::sqrt(uniform(random)), share = uniform(random);
  return {static_cast<float>(1.0 - root), static_cast<float>(root * (1.0 - share)), static_cast<float>(root * share)};
}

SurfacePoint pointIn(const Scene& scene, const RayScene& rays, const Triangle& triangle, const std::array<float, 3>& weights) {
  const auto& primitive = *triangle.primitive;
  SurfacePoint point;
  point.weights = weights;
  glm::dvec3 position(0.0), normal(0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto v = primitive.indices[triangle.firstIndex + c];
    point.vertices[c] = triangle.firstVertex + v;
    position += static_cast<double>(weights[c]) * glm::dvec3(primitive.positions[v]);
    normal += static_cast<double>(weights[c]) * glm::dvec3(primitive.normals[v]);
  }
  const double length = glm::length(normal);
  // Corner normals may cancel; then the triangle's own is as good as any.
  normal = length > 1e-6
               ? normal / length
               : glm::normalize(glm::cross(corner(triangle, 1) - corner(triangle, 0), corner(triangle, 2) - corner(triangle, 0)));
  const double offset = static_cast<double>(rays.surfaceOffset(glm::vec3(position)));
  point.view = {.normal = glm::vec3(normal),
                .front = glm::vec3(position + offset * normal),
                .back = glm::vec3(position - offset * normal),
                .doubleSided = materialOf(scene, primitive).doubleSided};
  return point;
}

}  // namespace

std::vector<std::size_t> randomSubset(std::size_t count, std::size_t wanted, std::uint32_t seed) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::mt19937 random(seed);
  wanted = std::min(wanted, count);
  for (std::size_t i = 0; i < wanted; ++i)
    std::swap(all[i], all[i + static_cast<std::size_t>(uniform(random) * static_cast<double>(count - i))]);
  all.resize(wanted);
  return all;
}

std::vector<SurfacePoint> pointsAtVertices(const std::vector<Viewpoint>& viewpoints, std::size_t wanted, std::uint32_t seed) {
  std::vector<SurfacePoint> points;
  for (const auto v : randomSubset(viewpoints.size(), wanted, seed))
    points.push_back({.vertices = {v, v, v}, .view = viewpoints[v]});
  return points;
}

std::vector<SurfacePoint> pointsInTriangles(const Scene& scene, const RayScene& rays, std::size_t wanted, std::uint32_t seed) {
  std::vector<Triangle> triangles;
  std::vector<double> areaUpTo;
  std::size_t firstVertex = 0;
  double area = 0.0;
  for (const auto& primitive : scene.primitives) {
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
      const auto& triangle = triangles.emplace_back(Triangle{&primitive, firstVertex, i});
      area += 0.5 * glm::length(glm::cross(corner(triangle, 1) - corner(triangle, 0), corner(triangle, 2) - corner(triangle, 0)));
      areaUpTo.push_back(area);
    }
    firstVertex += primitive.positions.size();
  }
  std::vector<SurfacePoint> points;
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < wanted && area > 0.0; ++i) {
    const auto found = std::upper_bound(areaUpTo.begin(), areaUpTo.end(), uniform(random) * area) - areaUpTo.begin();
    const auto chosen = std::min(static_cast<std::size_t>(found), triangles.size() - 1);
    points.push_back(pointIn(scene, rays, triangles[chosen], randomWeights(random)));
  }
  return points;
}

}  // namespace chiaro
