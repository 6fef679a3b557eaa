#include "assets/scene/primitive_normals.h"

#include <cmath>

namespace chiaro {
namespace {

constexpr glm::vec3 kFallback{0.0f, 1.0f, 0.0f};
/// A float vector that was normalised in float is within this of unit squared length; renormalising it would only move its bits.
constexpr double kUnitTolerance = 1e-6;

/// Twice the area times the normal, in double: float underflows on millimetre triangles of kilometre scenes.
glm::dvec3 areaNormal(const Primitive& primitive, std::size_t triangle) {
  const glm::dvec3 a = primitive.positions[primitive.indices[3 * triangle]];
  const glm::dvec3 b = primitive.positions[primitive.indices[3 * triangle + 1]];
  const glm::dvec3 c = primitive.positions[primitive.indices[3 * triangle + 2]];
  return glm::cross(b - a, c - a);
}

glm::vec3 unitOr(glm::dvec3 v, glm::vec3 fallback) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

template <class Vector>
std::vector<Vector> gather(const std::vector<Vector>& values, const std::vector<std::uint32_t>& indices) {
  std::vector<Vector> out;
  if (values.empty()) return out;
  out.reserve(indices.size());
  for (const auto index : indices) out.push_back(values[index]);
  return out;
}

}  // namespace

void makeFlat(Primitive& primitive) {
  std::vector<glm::vec3> normals(primitive.indices.size());
  for (std::size_t t = 0; t < primitive.triangleCount(); ++t) {
    const glm::vec3 normal = unitOr(areaNormal(primitive, t), kFallback);
    for (std::size_t k = 0; k < 3; ++k) normals[3 * t + k] = normal;
  }
  primitive.positions = gather(primitive.positions, primitive.indices);
  primitive.texcoords = gather(primitive.texcoords, primitive.indices);
  primitive.normals = std::move(normals);
  primitive.tangents.clear();
  for (std::size_t i = 0; i < primitive.indices.size(); ++i) primitive.indices[i] = static_cast<std::uint32_t>(i);
}

std::size_t normalizeNormals(Primitive& primitive) {
  std::size_t replaced = 0;
  std::vector<glm::dvec3> means;
  for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
    glm::vec3& normal = primitive.normals[i];
    const glm::dvec3 wide(normal);
    const double squared = glm::dot(wide, wide);
    if (std::abs(squared - 1.0) <= kUnitTolerance) continue;
    if (squared > 1e-20) {
      normal = glm::vec3(wide / std::sqrt(squared));
      continue;
    }
    if (means.empty()) {
      means.resize(primitive.positions.size());
      for (std::size_t t = 0; t < primitive.triangleCount(); ++t)
        for (std::size_t k = 0; k < 3; ++k) means[primitive.indices[3 * t + k]] += areaNormal(primitive, t);
    }
    normal = unitOr(means[i], kFallback);
    ++replaced;
  }
  return replaced;
}

}  // namespace chiaro
