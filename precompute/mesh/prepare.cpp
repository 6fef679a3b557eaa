#include "assets/error.h"
#include "precompute/bake.h"
#include "precompute/mesh/half_edge.h"
#include "precompute/mesh/normals.h"
#include "precompute/mesh/tangents.h"
#include "precompute/mesh/weld.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace chiaro {
namespace {

/// Scans are often wound inside out (the bunny is), and a mesh file has no other say on which side is the front. The volume that the
/// triangles enclose about their middle is negative then. Only a mesh that is closed but for a few holes is judged so: of a closed surface
/// the area vectors cancel, of a floor with things on it they do not, and its volume says nothing.
void turnInsideOut(Primitive& primitive, RepairReport& report) {
  if (primitive.positions.empty()) return;
  glm::dvec3 middle(0.0);
  for (const auto& position : primitive.positions) middle += glm::dvec3(position) / static_cast<double>(primitive.positions.size());
  const auto corner = [&](std::size_t i) { return glm::dvec3(primitive.positions[primitive.indices[i]]) - middle; };
  double volume = 0.0, magnitude = 0.0, area = 0.0;
  glm::dvec3 areaVector(0.0);
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    const double cone = glm::dot(corner(i), glm::cross(corner(i + 1), corner(i + 2)));
    volume += cone;
    magnitude += std::abs(cone);
    const auto normal = glm::cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i));
    areaVector += normal;
    area += glm::length(normal);
  }
  if (!(volume < -0.2 * magnitude && glm::length(areaVector) < 0.1 * area)) return;
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
  report.trianglesTurned += primitive.triangleCount();
}

/// A scene whose float coordinates are coarse steps over its whole size has fallen together, and its triangles with it.
bool tooFarFromTheOrigin(const Scene& scene) {
  constexpr float kStepsAcross = 64.0f;
  const Bounds bounds = boundsOf(scene);
  if (bounds.empty()) return false;
  const glm::vec3 largest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
  const float step = std::numeric_limits<float>::epsilon() * std::max({largest.x, largest.y, largest.z});
  return bounds.diagonal() < kStepsAcross * step;
}

}  // namespace

Scene prepareScene(Scene scene, float creaseAngle, RepairReport& report) {
  report = {};
  const bool tooFar = tooFarFromTheOrigin(scene);
  Scene result = std::move(scene);
  for (auto& primitive : result.primitives) {
    const auto& material = materialOf(result, primitive);
    if (!needsTangents(material, primitive)) primitive.tangents.clear();  // they must not keep equal vertices apart
    cleanPrimitive(primitive, report);
    if (primitive.normals.empty()) turnInsideOut(primitive, report);
    const auto edges = buildHalfEdges(primitive.positions, primitive.indices, weldPositions(primitive.positions));
    report.nonManifoldEdges += edges.nonManifoldEdges;
    report.boundaryEdges += edges.boundaryEdges;
    if (primitive.normals.empty())
      computeNormals(primitive, edges, creaseAngle, report);
    else
      repairNormals(primitive, report);
    makeTangents(primitive, material, report);
  }
  std::erase_if(result.primitives, [](const Primitive& primitive) { return primitive.indices.empty(); });
  if (result.primitives.empty() && tooFar)
    throw inputError("scene", "stands too far from the origin for coordinates in single precision, and falls together",
                     "move it to the origin");
  return result;
}

}  // namespace chiaro
