#pragma once
/// A scene's textures decoded once and read at any coordinate, as a GPU without mipmaps would.

#include <glm/glm.hpp>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// What the bytes of a texture mean.
enum class TextureEncoding {
  srgb,    ///< colours: RGB is decoded to linear before it is interpolated, A is linear
  linear,  ///< everything else
};

/// IEC 61966-2-1, for one channel in [0,1].
float srgbToLinear(float encoded);

class TextureSampler {
 public:
  /// Throws Error (unreadableInput) when the image cannot be decoded.
  TextureSampler(const Scene& scene, int texture, TextureEncoding encoding);

  /// RGBA at a texture coordinate, (0,0) the image's top left corner; texel centres at half integers. Bilinear, or the nearest
  /// texel where the texture asks for it, with its wrap modes. Coordinates that are not finite read as 0.
  glm::vec4 at(glm::vec2 texcoord) const;

 private:
  glm::vec4 texel(int x, int y) const;

  int width_ = 0;
  int height_ = 0;
  Texture description_;
  bool srgb_ = false;
  std::vector<std::uint8_t> texels_;
};

/// Interpolated TEXCOORD_0 of a triangle; (0,0) for a primitive without.
glm::vec2 texcoordAt(const Primitive& primitive, std::uint32_t triangle, glm::vec2 barycentric);

}  // namespace chiaro
