#pragma once
/// The half-edge mesh of a triangle list, whatever the list looks like.

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

namespace chiaro {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<>;

struct HalfEdges {
  HalfEdgeMesh mesh;                     ///< face f is triangle f of the list; the corners keep their order
  std::size_t nonManifoldEdges = 0;      ///< edges of more than two triangles, or of two wound against each other
  std::size_t boundaryEdges = 0;         ///< edges of one triangle
  std::size_t splitTriangles = 0;        ///< triangles that got vertices of their own because the mesh would not take them

  /// Half-edge from corner `corner` of triangle `face` to the next corner.
  HalfEdgeMesh::HalfedgeHandle halfedge(std::size_t face, int corner) const;
  /// Corner (0..2) of the face that half-edge `h` leaves from.
  int cornerOf(HalfEdgeMesh::HalfedgeHandle h) const;

  /// The half-edge of the triangle across half-edge `h` of a triangle: also where splitting tore apart an edge that just two triangles
  /// share with the same winding. Invalid on boundaries and non-manifold edges.
  HalfEdgeMesh::HalfedgeHandle across(HalfEdgeMesh::HalfedgeHandle h) const;

  std::vector<HalfEdgeMesh::HalfedgeHandle> firstHalfedge;  ///< from corner 0 of each triangle
  std::unordered_map<int, int> torn;                        ///< half-edge to half-edge, both ways
};

/// `positions` and `indices` describe the triangles; vertices count as one where `welded` (weldPositions()) says so.
/// No triangle may repeat a welded corner.
HalfEdges buildHalfEdges(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices,
                         const std::vector<std::uint32_t>& welded);

}  // namespace chiaro
