#include "assets/builtin/pattern.h"

#include <algorithm>
#include <cmath>

#include "assets/image/image.h"

namespace chiaro::builtin {
namespace {

/// A number in [-1,1] for a lattice point.
double latticeValue(int x, int y, std::uint32_t seed) {
  std::uint32_t h =
      seed * 0x9e3779b9u + static_cast<std::uint32_t>(x) * 0x85ebca6bu + static_cast<std::uint32_t>(y) * 0xc2b2ae35u;
  h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12u)) * 0x297a2d39u;
  h ^= h >> 15u;
  return static_cast<double>(h) / 2147483647.5 - 1.0;
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

std::uint8_t toByte(double value) { return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0))); }

double linearToSrgb(double value) {
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(std::min(value, 1.0), 1.0 / 2.4) - 0.055;
}

int addTexture(Scene& scene, const std::string& name, int size, const std::function<glm::dvec3(glm::dvec2)>& encoded) {
  Image8 image{size, size, {}};
  image.texels.reserve(4 * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::dvec3 value = encoded(glm::dvec2(x + 0.5, y + 0.5) / static_cast<double>(size));
      image.texels.insert(image.texels.end(), {toByte(value.x), toByte(value.y), toByte(value.z), 255});
    }
  }
  scene.images.push_back({name, "image/png", encodePng(image)});
  Texture texture;
  texture.image = static_cast<int>(scene.images.size()) - 1;
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

}  // namespace

double periodicNoise(glm::dvec2 uv, int cells, std::uint32_t seed) {
  const glm::dvec2 at = (uv - glm::floor(uv)) * static_cast<double>(cells);
  const glm::dvec2 cell = glm::floor(at);
  const glm::dvec2 f(fade(at.x - cell.x), fade(at.y - cell.y));
  const int x = static_cast<int>(cell.x);
  const int y = static_cast<int>(cell.y);
  const auto value = [&](int dx, int dy) { return latticeValue((x + dx) % cells, (y + dy) % cells, seed); };
  return std::lerp(std::lerp(value(0, 0), value(1, 0), f.x), std::lerp(value(0, 1), value(1, 1), f.x), f.y);
}

double periodicTurbulence(glm::dvec2 uv, int cells, int octaves, std::uint32_t seed) {
  double sum = 0.0;
  double strength = 0.5;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += strength * periodicNoise(uv, cells << octave, seed + static_cast<std::uint32_t>(octave));
    strength *= 0.5;
  }
  return sum / (1.0 - strength * 2.0) * 0.5;
}

double stripe(double x, double halfWidth, double blur) {
  const double distance = std::abs(x - std::round(x));
  const double t = std::clamp((distance - halfWidth) / blur, 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

int addColorTexture(Scene& scene, const std::string& name, int size, const std::function<glm::dvec3(glm::dvec2)>& color) {
  return addTexture(scene, name, size, [&](glm::dvec2 uv) {
    const glm::dvec3 c = glm::max(color(uv), glm::dvec3(0.0));
    return glm::dvec3(linearToSrgb(c.x), linearToSrgb(c.y), linearToSrgb(c.z));
  });
}

int addDataTexture(Scene& scene, const std::string& name, int size, const std::function<glm::dvec3(glm::dvec2)>& data) {
  return addTexture(scene, name, size, data);
}

int addNormalTexture(Scene& scene, const std::string& name, int size, glm::dvec2 patchSize,
                     const std::function<double(glm::dvec2)>& height) {
  const double step = 0.5 / size;
  return addTexture(scene, name, size, [&](glm::dvec2 uv) {
    const double right = (height(uv + glm::dvec2(step, 0.0)) - height(uv - glm::dvec2(step, 0.0))) / (2.0 * step * patchSize.x);
    const double up = (height(uv - glm::dvec2(0.0, step)) - height(uv + glm::dvec2(0.0, step))) / (2.0 * step * patchSize.y);
    return 0.5 + 0.5 * glm::normalize(glm::dvec3(-right, -up, 1.0));
  });
}

}  // namespace chiaro::builtin
