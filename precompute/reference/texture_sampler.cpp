#include "precompute/reference/texture_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "assets/image/image.h"

namespace chiaro {
namespace {

/// The texel that a wrap mode puts at `index`.
int wrapped(int index, int size, Wrap wrap) {
  const auto modulo = [](int value, int period) {
    const int remainder = value % period;
    return remainder < 0 ? remainder + period : remainder;
  };
  switch (wrap) {
    case Wrap::repeat:
      return modulo(index, size);
    case Wrap::mirroredRepeat: {
      const int folded = modulo(index, 2 * size);
      return folded < size ? folded : 2 * size - 1 - folded;
    }
    case Wrap::clampToEdge:
      break;
  }
  return std::clamp(index, 0, size - 1);
}

/// The coordinate as texels, brought near zero first: an int holds no coordinate of 1e10, and a float no fraction of it.
double inTexels(float coordinate, int size, Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0.0;
  const double value = static_cast<double>(coordinate);
  if (wrap == Wrap::clampToEdge) return std::clamp(value, -1.0, 2.0) * size;
  return (value - 2.0 * std::floor(0.5 * value)) * size;
}

const std::array<float, 256>& srgbTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = srgbToLinear(static_cast<float>(i) / 255.0f);
    return values;
  }();
  return table;
}

}  // namespace

float srgbToLinear(float encoded) { return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f); }

TextureSampler::TextureSampler(const Scene& scene, int texture, TextureEncoding encoding)
    : description_(scene.textures.at(static_cast<std::size_t>(texture))), srgb_(encoding == TextureEncoding::srgb) {
  const EncodedImage& encoded = scene.images.at(static_cast<std::size_t>(description_.image));
  Image8 image = decodeImage8(encoded.bytes, encoded.name);
  width_ = image.width;
  height_ = image.height;
  texels_ = std::move(image.texels);
}

glm::vec4 TextureSampler::texel(int x, int y) const {
  const auto column = static_cast<std::size_t>(wrapped(x, width_, description_.wrapS));
  const auto row = static_cast<std::size_t>(wrapped(y, height_, description_.wrapT));
  const std::uint8_t* bytes = &texels_[4 * (row * static_cast<std::size_t>(width_) + column)];
  const auto value = [&](int channel) {
    return srgb_ && channel < 3 ? srgbTable()[bytes[channel]] : static_cast<float>(bytes[channel]) / 255.0f;
  };
  return {value(0), value(1), value(2), value(3)};
}

glm::vec4 TextureSampler::at(glm::vec2 texcoord) const {
  const double x = inTexels(texcoord.x, width_, description_.wrapS);
  const double y = inTexels(texcoord.y, height_, description_.wrapT);
  if (description_.nearest) return texel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
  const double left = std::floor(x - 0.5);
  const double top = std::floor(y - 0.5);
  const auto fx = static_cast<float>(x - 0.5 - left);
  const auto fy = static_cast<float>(y - 0.5 - top);
  const int ix = static_cast<int>(left);
  const int iy = static_cast<int>(top);
  return glm::mix(glm::mix(texel(ix, iy), texel(ix + 1, iy), fx), glm::mix(texel(ix, iy + 1), texel(ix + 1, iy + 1), fx), fy);
}

glm::vec2 texcoordAt(const Primitive& primitive, std::uint32_t triangle, glm::vec2 barycentric) {
  if (primitive.texcoords.empty()) return glm::vec2(0.0f);
  const std::uint32_t* corner = &primitive.indices[3 * static_cast<std::size_t>(triangle)];
  return (1.0f - barycentric.x - barycentric.y) * primitive.texcoords[corner[0]] +
         barycentric.x * primitive.texcoords[corner[1]] + barycentric.y * primitive.texcoords[corner[2]];
}

}  // namespace chiaro
