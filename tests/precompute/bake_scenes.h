#pragma once
// Small scenes whose visibility is known, for the tests of the bake.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "assets/scene/scene.h"

namespace chiaro {

// Two triangles a cell, facing along cross(u, v), with that normal.
inline void addGrid(Primitive& primitive, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int cells) {
  const auto first = static_cast<std::uint32_t>(primitive.positions.size());
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const glm::vec2 share = glm::vec2(i, j) / static_cast<float>(cells);
      primitive.positions.push_back(corner + u * share.x + v * share.y);
      primitive.normals.push_back(glm::normalize(glm::cross(u, v)));
    }
  for (std::uint32_t j = 0; j + 1 < row; ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i;
      for (const std::uint32_t index : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) primitive.indices.push_back(index);
    }
}

// The plane y = 0, |x|, |z| <= half, facing up.
inline Primitive floorGrid(float half, int cells) {
  Primitive primitive;
  addGrid(primitive, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, cells);
  return primitive;
}

// A box that stands on y = 0 (no bottom), faces outwards.
inline Primitive standingBox(glm::vec2 center, float half, float height, int cells) {
  Primitive primitive;
  const float h = half;
  const glm::vec3 c(center.x, 0, center.y);
  addGrid(primitive, c + glm::vec3(-h, 0, h), {2 * h, 0, 0}, {0, height, 0}, cells);
  addGrid(primitive, c + glm::vec3(h, 0, -h), {-2 * h, 0, 0}, {0, height, 0}, cells);
  addGrid(primitive, c + glm::vec3(h, 0, h), {0, 0, -2 * h}, {0, height, 0}, cells);
  addGrid(primitive, c + glm::vec3(-h, 0, -h), {0, 0, 2 * h}, {0, height, 0}, cells);
  addGrid(primitive, c + glm::vec3(-h, height, h), {2 * h, 0, 0}, {0, 0, -2 * h}, cells);
  return primitive;
}

// A disc that fills the cone of `angle` radians about `axis` as seen from the origin, at `distance`.
inline Primitive capDisc(glm::vec3 axis, float angle, float distance, int segments = 256) {
  Primitive primitive;
  const glm::vec3 a = glm::normalize(axis), x = glm::normalize(glm::cross(a, std::abs(a.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0))), y = glm::cross(a, x);
  primitive.positions.push_back(distance * a);
  for (int i = 0; i < segments; ++i) {
    const float phi = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(segments);
    primitive.positions.push_back(distance * (a + std::tan(angle) * (std::cos(phi) * x + std::sin(phi) * y)));
    primitive.indices.insert(primitive.indices.end(), {0, static_cast<std::uint32_t>((i + 1) % segments + 1), static_cast<std::uint32_t>(i + 1)});
  }
  primitive.normals.assign(primitive.positions.size(), -a);
  return primitive;
}

inline Scene sceneWith(std::vector<Primitive> primitives) {
  Scene scene;
  scene.meshNames = {"mesh"};
  scene.primitives = std::move(primitives);
  return scene;
}

// Two boxes on a floor: 25 + 2 * 20 vertices at cells 4 and 1.
inline Scene boxesOnFloor(int cells = 4) {
  return sceneWith({floorGrid(2.0f, cells), standingBox({-0.6f, 0.2f}, 0.4f, 1.0f, 1), standingBox({0.7f, -0.3f}, 0.3f, 1.6f, 1)});
}

inline Scene scaled(Scene scene, float scale, glm::vec3 shift = glm::vec3(0.0f)) {
  for (auto& primitive : scene.primitives)
    for (auto& p : primitive.positions) p = scale * p + shift;
  return scene;
}

}  // namespace chiaro
