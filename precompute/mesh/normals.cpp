#include "precompute/mesh/normals.h"

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "precompute/mesh/weld.h"

namespace chiaro {
namespace {

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t cornerIndex(const HalfEdges& edges, HalfEdgeMesh::HalfedgeHandle h) {
  return static_cast<std::uint32_t>(3 * edges.mesh.face_handle(h).idx() + edges.cornerOf(h));
}

std::vector<glm::dvec3> triangleNormals(const Primitive& primitive) {
  std::vector<glm::dvec3> result;
  result.reserve(primitive.triangleCount());
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3)
    result.push_back(triangleNormal(primitive.positions[primitive.indices[i]], primitive.positions[primitive.indices[i + 1]],
                                    primitive.positions[primitive.indices[i + 2]]));
  return result;
}

double angleOfCorner(const Primitive& primitive, std::size_t corner) {
  const auto first = corner / 3 * 3;
  const auto at = [&](std::size_t i) { return primitive.positions[primitive.indices[first + (corner + i) % 3]]; };
  return cornerAngle(at(0), at(1), at(2));
}

/// Triangles that cancel each other leave no direction; any one of theirs is better than none.
glm::vec3 unitOr(glm::dvec3 sum, glm::dvec3 fallback) {
  const double length = glm::length(sum);
  return glm::vec3(length > 1e-9 ? sum / length : fallback);
}

}  // namespace

void computeNormals(Primitive& primitive, const HalfEdges& edges, float creaseAngle, RepairReport& report) {
  const auto faceNormal = triangleNormals(primitive);
  const auto& mesh = edges.mesh;

  UnionFind groups(primitive.indices.size());
  const double leastCosine = std::cos(static_cast<double>(creaseAngle));
  for (const auto h : mesh.halfedges()) {
    if (mesh.is_boundary(h)) continue;
    const auto o = edges.across(h);
    if (!o.is_valid() || o.idx() < h.idx()) continue;
    const auto f = static_cast<std::size_t>(mesh.face_handle(h).idx()), g = static_cast<std::size_t>(mesh.face_handle(o).idx());
    if (!(glm::dot(faceNormal[f], faceNormal[g]) >= leastCosine)) continue;
    groups.join(cornerIndex(edges, h), cornerIndex(edges, mesh.next_halfedge_handle(o)));
    groups.join(cornerIndex(edges, o), cornerIndex(edges, mesh.next_halfedge_handle(h)));
  }

  std::vector<glm::dvec3> sum(primitive.indices.size(), glm::dvec3(0.0));
  for (std::uint32_t corner = 0; corner < sum.size(); ++corner)
    sum[groups.root(corner)] += angleOfCorner(primitive, corner) * faceNormal[corner / 3];

  // A vertex of the result is a vertex of the file (its texture coordinates) in one group.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertexOf;
  std::vector<std::uint32_t> source;
  std::vector<glm::vec3> normals;
  for (std::uint32_t corner = 0; corner < sum.size(); ++corner) {
    const auto group = groups.root(corner);
    const auto [it, isNew] = vertexOf.try_emplace({primitive.indices[corner], group}, static_cast<std::uint32_t>(source.size()));
    if (isNew) {
      source.push_back(primitive.indices[corner]);
      normals.push_back(unitOr(sum[group], faceNormal[corner / 3]));
    }
    primitive.indices[corner] = it->second;
  }
  primitive.tangents.clear();
  selectVertices(primitive, source);
  primitive.normals = std::move(normals);
  report.normalsComputed += source.size();
}

void repairNormals(Primitive& primitive, RepairReport& report) {
  constexpr double kLeastLength = 1e-6;
  std::vector<glm::dvec3> fromTriangles;
  for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
    const glm::dvec3 n(primitive.normals[i]);
    const double length = glm::length(n);
    if (!(std::abs(length - 1.0) <= 1e-3)) ++report.normalsRepaired;
    if (length >= kLeastLength && std::isfinite(length)) {
      primitive.normals[i] = glm::vec3(n / length);
      continue;
    }
    if (fromTriangles.empty()) {
      fromTriangles.assign(primitive.normals.size(), glm::dvec3(0.0));
      const auto faceNormal = triangleNormals(primitive);
      for (std::size_t corner = 0; corner < primitive.indices.size(); ++corner)
        fromTriangles[primitive.indices[corner]] += angleOfCorner(primitive, corner) * faceNormal[corner / 3];
    }
    primitive.normals[i] = unitOr(fromTriangles[i], glm::dvec3(0.0, 1.0, 0.0));
  }
}

}  // namespace chiaro
