#include "precompute/mesh/tangents.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "precompute/mesh/normals.h"
#include "precompute/mesh/weld.h"

namespace chiaro {
namespace {

/// Horizontal where that is possible, which suits brushed metal better than a frame that turns with a longest component.
glm::vec3 anyTangent(glm::vec3 n) {
  const auto t = std::abs(n.y) < 0.999f ? glm::cross(glm::vec3(0, 1, 0), n) : glm::cross(glm::vec3(0, 0, 1), n);
  return glm::normalize(t);
}

/// Perpendicular to n; anyTangent(n) where t has no such part.
glm::vec3 perpendicular(glm::dvec3 t, glm::vec3 normal) {
  const glm::dvec3 n(normal);
  const double before = glm::length(t);
  t -= glm::dot(t, n) * n;
  const double length = glm::length(t);
  return std::isfinite(before) && length > 1e-6 * before ? glm::vec3(t / length) : anyTangent(normal);
}

struct TextureFrame {
  glm::dvec3 tangent{0.0};  ///< unit, growing U; zero when the texture is collapsed here
  bool mirrored = false;    ///< w = -1
};

/// `linear`: of the transform through which the map is read.
TextureFrame textureFrame(const Primitive& primitive, const glm::dmat2& linear, std::size_t triangle) {
  const auto* i = &primitive.indices[3 * triangle];
  const glm::dvec3 p(primitive.positions[i[0]]);
  const auto e1 = glm::dvec3(primitive.positions[i[1]]) - p, e2 = glm::dvec3(primitive.positions[i[2]]) - p;
  const glm::dvec2 uv(primitive.texcoords[i[0]]);
  const auto d1 = linear * (glm::dvec2(primitive.texcoords[i[1]]) - uv),
             d2 = linear * (glm::dvec2(primitive.texcoords[i[2]]) - uv);
  const double determinant = d1.x * d2.y - d2.x * d1.y;
  TextureFrame frame;
  if (!(std::abs(determinant) > 0.0)) return frame;
  const auto alongU = (d2.y * e1 - d1.y * e2) / determinant;
  const double length = glm::length(alongU);
  if (!(length > 0.0) || !std::isfinite(length)) return frame;
  frame.tangent = alongU / length;
  // (dP/dU, dP/dV, n) is right-handed when the map keeps the winding; the image's up is -dP/dV, hence the opposite sign.
  frame.mirrored = determinant > 0.0;
  return frame;
}

void computeTangents(Primitive& primitive, const glm::dmat2& linear, RepairReport& report) {
  const auto vertexCount = primitive.positions.size();
  // Slot 0: w = +1, slot 1: w = -1.
  std::vector<std::array<glm::dvec3, 2>> sum(vertexCount, {glm::dvec3(0.0), glm::dvec3(0.0)});
  std::vector<std::array<bool, 2>> used(vertexCount, {false, false});
  std::vector<TextureFrame> frames(primitive.triangleCount());
  for (std::size_t t = 0; t < frames.size(); ++t) {
    frames[t] = textureFrame(primitive, linear, t);
    if (frames[t].tangent == glm::dvec3(0.0)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = [&](std::size_t k) { return primitive.positions[primitive.indices[3 * t + (c + k) % 3]]; };
      const auto v = primitive.indices[3 * t + c];
      const glm::dvec3 n(primitive.normals[v]);
      auto tangent = frames[t].tangent - glm::dot(frames[t].tangent, n) * n;
      const double length = glm::length(tangent);
      if (length > 1e-6) tangent /= length;
      sum[v][frames[t].mirrored] += cornerAngle(at(0), at(1), at(2)) * tangent;
      used[v][frames[t].mirrored] = true;
    }
  }

  std::vector<std::uint32_t> source(vertexCount);
  std::vector<std::uint32_t> mirroredTwin(vertexCount);
  for (std::uint32_t v = 0; v < vertexCount; ++v) {
    source[v] = mirroredTwin[v] = v;
    const bool mirrored = used[v][1] && !used[v][0];
    primitive.tangents.emplace_back(perpendicular(sum[v][mirrored], primitive.normals[v]), mirrored ? -1.0f : 1.0f);
  }
  for (std::uint32_t v = 0; v < vertexCount; ++v) {
    if (!(used[v][0] && used[v][1])) continue;
    mirroredTwin[v] = static_cast<std::uint32_t>(source.size());
    source.push_back(v);
  }
  selectVertices(primitive, source);
  for (std::uint32_t v = 0; v < vertexCount; ++v)
    if (mirroredTwin[v] != v)
      primitive.tangents[mirroredTwin[v]] = glm::vec4(perpendicular(sum[v][1], primitive.normals[v]), -1.0f);
  for (std::size_t t = 0; t < frames.size(); ++t)
    if (frames[t].mirrored)
      for (std::size_t c = 0; c < 3; ++c) primitive.indices[3 * t + c] = mirroredTwin[primitive.indices[3 * t + c]];
  report.tangentsComputed += source.size();
}

}  // namespace

bool needsTangents(const Material& material, const Primitive& primitive) {
  const bool hasTexcoords = !primitive.texcoords.empty();
  return (material.normalTexture != kNone && hasTexcoords) || material.anisotropyStrength > 0.0f ||
         reflectanceAlpha(material).x != reflectanceAlpha(material).y;
}

void makeTangents(Primitive& primitive, const Material& material, RepairReport& report) {
  if (!needsTangents(material, primitive)) {
    primitive.tangents.clear();
    return;
  }
  if (!primitive.tangents.empty()) {
    for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
      const auto t = primitive.tangents[i];
      primitive.tangents[i] = glm::vec4(perpendicular(glm::dvec3(t), primitive.normals[i]), t.w < 0.0f ? -1.0f : 1.0f);
    }
  } else if (!primitive.texcoords.empty()) {
    // A normal map turned on the surface turns its frame with it.
    const auto& map = material.normalTexture != kNone ? material.normalTransform : material.anisotropyTransform;
    computeTangents(primitive, glm::dmat2(map.linear()), report);
  } else {
    for (const auto& n : primitive.normals) primitive.tangents.emplace_back(anyTangent(n), 1.0f);
    report.tangentsComputed += primitive.normals.size();
  }
}

}  // namespace chiaro
