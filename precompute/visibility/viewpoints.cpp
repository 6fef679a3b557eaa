#include "precompute/visibility/viewpoints.h"

#include "precompute/mesh/normals.h"

namespace chiaro {
namespace {

/// Per vertex the angle-weighted mean of the directions into its triangles, in the tangent plane: zero-ish inside a smooth
/// surface, pointing inwards on a border or crease.
std::vector<glm::dvec3> inwardDirections(const Primitive& primitive) {
  std::vector<glm::dvec3> sum(primitive.positions.size(), glm::dvec3(0.0));
  std::vector<double> angles(primitive.positions.size(), 0.0);
  for (std::size_t t = 0; t < primitive.indices.size(); t += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = primitive.indices[t + c];
      const auto a = primitive.positions[v], b = primitive.positions[primitive.indices[t + (c + 1) % 3]],
                 d = primitive.positions[primitive.indices[t + (c + 2) % 3]];
      const auto u = glm::normalize(glm::dvec3(b) - glm::dvec3(a)), w = glm::normalize(glm::dvec3(d) - glm::dvec3(a));
      const double angle = cornerAngle(a, b, d);
      const auto middle = u + w;
      const double length = glm::length(middle);
      if (length > 1e-9) sum[v] += angle * middle / length;
      angles[v] += angle;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) {
    const glm::dvec3 n(primitive.normals[v]);
    sum[v] -= glm::dot(sum[v], n) * n;
    const double length = glm::length(sum[v]);
    // Below this the triangles surround the vertex, and what remains is no direction to trust.
    sum[v] = length > 0.05 * angles[v] ? sum[v] / length : glm::dvec3(0.0);
  }
  return sum;
}

}  // namespace

std::vector<Viewpoint> viewpointsOf(const Scene& scene, const RayScene& rays) {
  std::vector<Viewpoint> result;
  result.reserve(scene.vertexCount());
  for (const auto& primitive : scene.primitives) {
    const auto inward = inwardDirections(primitive);
    const bool doubleSided = materialOf(scene, primitive).doubleSided;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const glm::dvec3 p(primitive.positions[v]), n(primitive.normals[v]);
      const double offset = static_cast<double>(rays.surfaceOffset(primitive.positions[v]));
      result.push_back({.normal = primitive.normals[v],
                        .front = glm::vec3(p + offset * (inward[v] + n)),
                        .back = glm::vec3(p + offset * (inward[v] - n)),
                        .doubleSided = doubleSided});
    }
  }
  return result;
}

}  // namespace chiaro
