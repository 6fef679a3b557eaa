#pragma once
/// A small baked scene in which something hides something else.

#include <cstdint>
#include <glm/glm.hpp>
#include <utility>

#include "assets/builtin/builtin_scene.h"
#include "precompute/bake.h"

namespace chiaro {

/// A floor of 4 x 4 metres at y = 0.
inline Primitive floorOf(int cells) {
  Primitive floor;
  floor.material = 0;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      floor.positions.emplace_back(4.0f * static_cast<float>(i) / static_cast<float>(cells) - 2.0f, 0.0f, 4.0f * static_cast<float>(j) / static_cast<float>(cells) - 2.0f);
      floor.normals.emplace_back(0.0f, 1.0f, 0.0f);
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (cells + 1) + i), b = a + static_cast<std::uint32_t>(cells) + 1;
      for (const std::uint32_t corner : {a, b, a + 1, a + 1, b, b + 1}) floor.indices.push_back(corner);
    }
  return floor;
}

/// The built-in sphere, `height` over the floor, of radius .5.
inline BakedScene ballOverFloor(const Material& material, float height) {
  Scene scene = builtinScene("sphere");
  scene.cameras.clear();
  scene.materials = {material};
  for (auto& primitive : scene.primitives) {
    primitive.material = 0;
    for (auto& p : primitive.positions) p = 0.5f * p + glm::vec3(0.0f, height + 0.5f, 0.0f);
  }
  scene.primitives.push_back(floorOf(32));
  scene.primitives.back().mesh = scene.primitives.front().mesh;
  BakeSettings quick;
  quick.samplingResolution = 64;
  BakeReport report;
  return bake(std::move(scene), quick, report);
}

}  // namespace chiaro
