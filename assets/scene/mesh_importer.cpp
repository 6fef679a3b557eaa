#include "assets/scene/mesh_importer.h"

#include <algorithm>
#include <cmath>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr std::size_t kMostVertices = 0x7FFFFFFF;  // OpenMesh's handles are int

/// Twice the signed area of a projected triangle.
double cross2(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Projects a polygon along the axis its area is largest in (Newell's normal), keeping it counter-clockwise.
std::vector<glm::dvec2> flatten(const std::vector<glm::dvec3>& polygon) {
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // Relative to the first corner, so that a polygon far from the origin loses no digits.
    const glm::dvec3 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
    normal += glm::cross(a, b);
  }
  const glm::dvec3 size = glm::abs(normal);
  const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int u = (drop + 1) % 3, v = (drop + 2) % 3;
  const double sign = normal[drop] < 0.0 ? -1.0 : 1.0;
  std::vector<glm::dvec2> out;
  for (const auto& p : polygon) out.emplace_back(p[u], sign * p[v]);
  return out;
}

}  // namespace

std::size_t MeshImporter::checked(OpenMesh::VertexHandle vertex) const {
  if (vertex.idx() < 0 || static_cast<std::size_t>(vertex.idx()) >= positions_.size())
    throw inputError(where_,
                     "face " + std::to_string(polygons_) + " names vertex " + std::to_string(vertex.idx()) +
                         ", but there are only " + std::to_string(positions_.size()),
                     "export the mesh again");
  return static_cast<std::size_t>(vertex.idx());
}

glm::vec3 MeshImporter::checked(const OpenMesh::Vec3f& v, const char* what) const {
  if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
    throw inputError(where_, std::string("a ") + what + " near vertex " + std::to_string(positions_.size()) + " is not finite",
                     "export the mesh again");
  return {v[0], v[1], v[2]};
}

OpenMesh::VertexHandle MeshImporter::add_vertex(const OpenMesh::Vec3f& point) {
  if (positions_.size() >= kMostVertices) throw inputError(where_, "has more than 2^31 vertices", "split it");
  positions_.push_back(checked(point, "position"));
  return OpenMesh::VertexHandle(static_cast<int>(positions_.size() - 1));
}

OpenMesh::VertexHandle MeshImporter::add_vertex() { return add_vertex(OpenMesh::Vec3f(0.0f, 0.0f, 0.0f)); }

void MeshImporter::set_point(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3f& point) {
  positions_[checked(vertex)] = checked(point, "position");
}

MeshImporter::Corner& MeshImporter::pending(std::size_t vertex) {
  // The corner being read is nearly always the last one.
  for (auto corner = pending_.rbegin(); corner != pending_.rend(); ++corner)
    if (corner->vertex == vertex) return *corner;
  pending_.emplace_back();
  pending_.back().vertex = static_cast<std::uint32_t>(vertex);
  return pending_.back();
}

void MeshImporter::set_normal(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3f& normal) {
  const std::size_t index = checked(vertex);
  const glm::vec3 value = checked(normal, "normal");
  if (attributesPerCorner) {
    Corner& corner = pending(index);
    corner.normal = value;
    corner.hasNormal = true;
  } else {
    normals_.resize(positions_.size());
    normals_[index] = value;
  }
}

void MeshImporter::set_normal(OpenMesh::VertexHandle vertex, const OpenMesh::Vec3d& normal) {
  set_normal(vertex,
             OpenMesh::Vec3f(static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2])));
}

void MeshImporter::set_texcoord(OpenMesh::VertexHandle vertex, const OpenMesh::Vec2f& texcoord) {
  const std::size_t index = checked(vertex);
  const glm::vec2 value(checked(OpenMesh::Vec3f(texcoord[0], texcoord[1], 0.0f), "texture coordinate"));
  if (attributesPerCorner) {
    Corner& corner = pending(index);
    corner.texcoord = value;
    corner.hasTexcoord = true;
  } else {
    texcoords_.resize(positions_.size());
    texcoords_[index] = value;
  }
}

OpenMesh::FaceHandle MeshImporter::add_face(const VHandles& vertices) {
  std::vector<Corner> polygon;
  polygon.reserve(vertices.size());
  for (const auto vertex : vertices) {
    const std::size_t index = checked(vertex);
    const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Corner& c) { return c.vertex == index; });
    polygon.push_back(found != pending_.end() ? *found : Corner{static_cast<std::uint32_t>(index)});
  }
  pending_.clear();
  if (polygon.size() < 3)
    ++smallPolygons_;
  else
    triangulate(polygon);
  return OpenMesh::FaceHandle(static_cast<int>(polygons_++));
}

/// Ear clipping (Meisters 1975); what has no ear left (it crosses itself or has no area) is closed as a fan.
void MeshImporter::triangulate(const std::vector<Corner>& polygon) {
  const auto emit = [&](const Corner& a, const Corner& b, const Corner& c) {
    corners_.insert(corners_.end(), {a, b, c});
    polygonOfTriangle_.push_back(static_cast<std::uint32_t>(polygons_));
  };
  std::vector<std::size_t> left(polygon.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  if (polygon.size() > 3) {
    std::vector<glm::dvec3> points;
    for (const auto& corner : polygon) points.emplace_back(positions_[corner.vertex]);
    const auto flat = flatten(points);
    const auto isEar = [&](std::size_t i) {
      const std::size_t n = left.size();
      const std::size_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
      if (!(cross2(flat[a], flat[b], flat[c]) > 0.0)) return false;
      return std::none_of(left.begin(), left.end(), [&](std::size_t p) {
        return p != a && p != b && p != c && cross2(flat[a], flat[b], flat[p]) >= 0.0 &&
               cross2(flat[b], flat[c], flat[p]) >= 0.0 && cross2(flat[c], flat[a], flat[p]) >= 0.0;
      });
    };
    // Clipping starts behind the last ear, which makes fans of convex polygons in linear time.
    std::size_t i = 1, misses = 0;
    while (left.size() > 3 && misses < left.size()) {
      const std::size_t n = left.size();
      i %= n;
      if (isEar(i)) {
        emit(polygon[left[(i + n - 1) % n]], polygon[left[i]], polygon[left[(i + 1) % n]]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        misses = 0;
      } else {
        ++i;
        ++misses;
      }
    }
  }
  for (std::size_t k = 2; k < left.size(); ++k) emit(polygon[left[0]], polygon[left[k - 1]], polygon[left[k]]);
}

}  // namespace chiaro
