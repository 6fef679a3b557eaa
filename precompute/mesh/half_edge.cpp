#include "precompute/mesh/half_edge.h"

#include <array>
#include <unordered_map>

namespace chiaro {
namespace {

using Mesh = HalfEdgeMesh;

/// Whether add_face() would take the triangle: each corner still has room (is on a boundary) and each edge's side is free.
bool fits(const Mesh& mesh, const std::array<Mesh::VertexHandle, 3>& corner) {
  for (int i = 0; i < 3; ++i) {
    const auto from = corner[static_cast<std::size_t>(i)];
    const auto to = corner[static_cast<std::size_t>((i + 1) % 3)];
    if (!mesh.is_boundary(from)) return false;
    const auto h = mesh.find_halfedge(from, to);
    if (h.is_valid() && !mesh.is_boundary(h)) return false;
  }
  return true;
}

struct EdgeUse {
  std::uint32_t forward = 0;  ///< triangles that run from the lower to the higher vertex
  std::uint32_t backward = 0;
  int halfedge[2] = {-1, -1};  ///< the last of each
};

/// Counts the edges between welded positions, and finds the pairs of half-edges that belong together though the mesh has them apart.
void matchEdges(const std::vector<std::uint32_t>& indices, const std::vector<std::uint32_t>& welded, HalfEdges& result) {
  std::unordered_map<std::uint64_t, EdgeUse> edges;
  edges.reserve(indices.size());
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t a = welded[indices[t + i]], b = welded[indices[t + (i + 1) % 3]];
      auto& use = edges[a < b ? (a << 32 | b) : (b << 32 | a)];
      ++(a < b ? use.forward : use.backward);
      use.halfedge[a < b ? 0 : 1] = result.halfedge(t / 3, static_cast<int>(i)).idx();
    }
  }
  for (const auto& [key, use] : edges) {
    if (use.forward > 1 || use.backward > 1)
      ++result.nonManifoldEdges;
    else if (use.forward + use.backward == 1)
      ++result.boundaryEdges;
    else if (result.mesh.opposite_halfedge_handle(Mesh::HalfedgeHandle(use.halfedge[0])).idx() != use.halfedge[1]) {
      result.torn[use.halfedge[0]] = use.halfedge[1];
      result.torn[use.halfedge[1]] = use.halfedge[0];
    }
  }
}

}  // namespace

Mesh::HalfedgeHandle HalfEdges::halfedge(std::size_t face, int corner) const {
  auto h = firstHalfedge[face];
  for (int i = 0; i < corner; ++i) h = mesh.next_halfedge_handle(h);
  return h;
}

int HalfEdges::cornerOf(Mesh::HalfedgeHandle h) const {
  const auto first = firstHalfedge[static_cast<std::size_t>(mesh.face_handle(h).idx())];
  if (h == first) return 0;
  return h == mesh.next_halfedge_handle(first) ? 1 : 2;
}

Mesh::HalfedgeHandle HalfEdges::across(Mesh::HalfedgeHandle h) const {
  const auto opposite = mesh.opposite_halfedge_handle(h);
  if (!mesh.is_boundary(opposite)) return opposite;
  const auto it = torn.find(h.idx());
  return it == torn.end() ? Mesh::HalfedgeHandle() : Mesh::HalfedgeHandle(it->second);
}

HalfEdges buildHalfEdges(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices,
                         const std::vector<std::uint32_t>& welded) {
  HalfEdges result;
  auto& mesh = result.mesh;
  mesh.reserve(positions.size(), indices.size() / 2, indices.size() / 3);
  const auto addVertex = [&](std::uint32_t i) {
    return mesh.add_vertex(Mesh::Point(positions[i].x, positions[i].y, positions[i].z));
  };
  std::vector<Mesh::VertexHandle> vertex(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i)
    if (welded[i] == i) vertex[i] = addVertex(i);

  // A refusal that fits() did not foresee (a vertex whose fans cannot be relinked) prints a line; splitting answers it too.
  const bool wasEnabled = omerr().is_enabled();
  omerr().disable();
  result.firstHalfedge.reserve(indices.size() / 3);
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    const std::array<std::uint32_t, 3> i{welded[indices[t]], welded[indices[t + 1]], welded[indices[t + 2]]};
    std::array<Mesh::VertexHandle, 3> corner{vertex[i[0]], vertex[i[1]], vertex[i[2]]};
    auto face = fits(mesh, corner) ? mesh.add_face(corner[0], corner[1], corner[2]) : Mesh::FaceHandle();
    if (!face.is_valid()) {
      corner = {addVertex(i[0]), addVertex(i[1]), addVertex(i[2])};
      face = mesh.add_face(corner[0], corner[1], corner[2]);
      ++result.splitTriangles;
    }
    result.firstHalfedge.push_back(mesh.find_halfedge(corner[0], corner[1]));
  }
  if (wasEnabled) omerr().enable();

  matchEdges(indices, welded, result);
  return result;
}

}  // namespace chiaro
