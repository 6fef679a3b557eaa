#pragma once
/// Receives what OpenMesh's file readers find, without building a mesh of it: faces that no half-edge mesh could hold
/// (non-manifold, duplicate) are kept, as repairing them is the offline stage's work.

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <cstdint>
#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// Attributes given between two faces belong to the corners of the second one (OBJ); those given without faces, to the
/// vertices (PLY). Throws Error (unreadableInput) at the first value that is not finite and the first index out of range.
class MeshImporter final : public OpenMesh::IO::BaseImporter {
 public:
  explicit MeshImporter(std::string where) : where_(std::move(where)) {}

  /// One triangulated polygon; `corner` indexes vertices, or kNone.
  struct Corner {
    std::uint32_t vertex = 0;
    glm::vec2 texcoord{0.0f};
    glm::vec3 normal{0.0f};
    bool hasTexcoord = false;
    bool hasNormal = false;
  };

  /// Attributes per corner rather than per vertex.
  bool attributesPerCorner = false;

  const std::vector<glm::vec3>& positions() const { return positions_; }
  std::vector<glm::vec3>& normals() { return normals_; }      ///< empty or per vertex
  std::vector<glm::vec2>& texcoords() { return texcoords_; }  ///< empty or per vertex, as in the file (v up)
  /// 3 per triangle, with attributes when attributesPerCorner.
  const std::vector<Corner>& corners() const { return corners_; }
  /// For each triangle, the number of the polygon (add_face call) it comes from.
  const std::vector<std::uint32_t>& polygonOfTriangle() const { return polygonOfTriangle_; }
  std::size_t polygons() const { return polygons_; }
  std::size_t smallPolygons() const { return smallPolygons_; }  ///< with fewer than three corners, left out

  using OpenMesh::IO::BaseImporter::add_vertex;
  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& point) override;
  OpenMesh::VertexHandle add_vertex() override;
  OpenMesh::FaceHandle add_face(const VHandles& vertices) override;
  void set_point(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3f& point) override;
  void set_normal(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3f& normal) override;
  void set_normal(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3d& normal) override;
  void set_texcoord(OpenMesh::VertexHandle vertex, const OpenMesh::Vec2f& texcoord) override;
  std::size_t n_vertices() const override { return positions_.size(); }
  std::size_t n_faces() const override { return polygons_; }
  std::size_t n_edges() const override { return 0; }

  // Nothing of the following is kept.
  OpenMesh::HalfedgeHandle add_edge(OpenMesh::VertexHandle, OpenMesh::VertexHandle) override {
    return OpenMesh::HalfedgeHandle();
  }
  OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle) override { return OpenMesh::FaceHandle(); }
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(OpenMesh::FaceHandle, int) override {}
  void set_halfedge(OpenMesh::VertexHandle, OpenMesh::HalfedgeHandle) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::VertexHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_next(OpenMesh::HalfedgeHandle, OpenMesh::HalfedgeHandle) override {}
  void set_face(OpenMesh::HalfedgeHandle, OpenMesh::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(OpenMesh::HalfedgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::EdgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::FaceHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  std::size_t checked(OpenMesh::VertexHandle vertex) const;
  glm::vec3 checked(const OpenMesh::Vec3f& v, const char* what) const;
  Corner& pending(std::size_t vertex);
  void triangulate(const std::vector<Corner>& polygon);

  std::string where_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> texcoords_;
  std::vector<Corner> pending_, corners_;
  std::vector<std::uint32_t> polygonOfTriangle_;
  std::size_t polygons_ = 0, smallPolygons_ = 0;
};

}  // namespace chiaro
