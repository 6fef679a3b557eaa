#pragma once
/// Scenes without any transfer error, so that a picture speaks of the shading alone.

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "assets/builtin/builtin_scene.h"
#include "assets/transfer/transfer.h"
#include "runtime/render/renderer.h"

namespace chiaro {

/// What a bake of an unoccluded scene gives: no terms, everything visible.
inline BakedScene unoccluded(Scene scene, std::uint8_t visibility = 255) {
  BakedScene baked;
  baked.scene = std::move(scene);
  Transfer& t = baked.transfer;
  t.resolution = 16;
  t.directionCount = 32;
  t.directionSharpness = 32.0f;
  for (int i = 0; i < 32; ++i) {
    const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / 32.0f, s = std::sqrt(1.0f - z * z), phi = static_cast<float>(i) * 2.39996323f;
    t.directions.emplace_back(s * std::cos(phi), s * std::sin(phi), z);
  }
  for (const auto& primitive : baked.scene.primitives) t.primitives.push_back({{}, std::vector<std::uint8_t>(primitive.positions.size() * 32, visibility), {}});
  return baked;
}

inline BakedScene sphereOf(const Material& m) {
  Scene scene = builtinScene("sphere");
  scene.materials = {m};
  for (auto& primitive : scene.primitives) primitive.material = 0;
  return unoccluded(std::move(scene));
}

inline RenderSettings smallPicture(int size) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.background = false;
  return settings;
}

}  // namespace chiaro
