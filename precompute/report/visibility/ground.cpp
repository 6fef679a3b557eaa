#include "precompute/report/visibility/ground.h"

namespace chiaro {

void addGround(Scene& scene) {
  constexpr std::uint32_t kSide = 40;
  const Bounds bounds = boundsOf(scene);
  if (bounds.empty()) return;
  const float width = 3.0f * bounds.diagonal(), height = bounds.lower.y - 1e-3f * bounds.diagonal();
  Primitive ground;
  ground.name = "ground";
  ground.mesh = static_cast<int>(scene.meshNames.size());
  scene.meshNames.emplace_back("ground");
  for (std::uint32_t j = 0; j < kSide; ++j)
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const glm::vec2 share = glm::vec2(i, j) / static_cast<float>(kSide - 1) - 0.5f;
      ground.positions.emplace_back(bounds.center().x + share.x * width, height, bounds.center().z - share.y * width);
      ground.normals.emplace_back(0.0f, 1.0f, 0.0f);
    }
  for (std::uint32_t j = 0; j + 1 < kSide; ++j)
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
      const auto a = j * kSide + i;
      for (const auto index : {a, a + 1, a + kSide + 1, a, a + kSide + 1, a + kSide}) ground.indices.push_back(index);
    }
  scene.primitives.push_back(std::move(ground));
}

}  // namespace chiaro
