#pragma once
/// How wet a scene is, texel by texel; may change every frame. Materials darken and get smoother by it (shaders/stage/wetness.glsl).

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

struct Wetness {
  int width = 0, height = 0;         ///< at least 1
  std::vector<std::uint8_t> texels;  ///< 0 dry to 255 soaked, row by row from t = 0
  /// Texture coordinates (s, t) of a baked world position p are dot(s, (p, 1)) and dot(t, (p, 1)); the map repeats. Rain from above: of x and z.
  glm::vec4 s{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec4 t{0.0f, 0.0f, 1.0f, 0.0f};
};

}  // namespace chiaro
