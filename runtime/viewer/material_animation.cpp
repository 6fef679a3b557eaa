#include "runtime/viewer/material_animation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr double kPeriod = 4.0;
constexpr float kDarkest = 0.4f;     // of the base colour, soaked
constexpr float kSmoothest = 0.35f;  // of the perceptual roughness under water

float smoother(float width, bool exponent, float factor) {
  const float alpha = (exponent ? alphaFromExponent(width) : width) * factor;
  return exponent ? std::clamp(exponentFromAlpha(alpha), kLeastExponent, kMostExponent) : std::max(alpha, kLeastWidth);
}

}  // namespace

MaterialAnimation materialAnimationFromName(const std::string& name) {
  if (name == "none") return MaterialAnimation::none;
  if (name == "wetness") return MaterialAnimation::wetness;
  throw usageError("--animate", "unknown animation \"" + name + "\"", "give none or wetness");
}

float wetnessAt(double seconds) { return static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * seconds / kPeriod)); }

std::vector<Material> wetMaterials(const std::vector<Material>& dry, float wetness) {
  std::vector<Material> wet = dry;
  for (auto& m : wet) {
    const float porous = (1.0f - m.metallicFactor) * wetness;
    m.baseColorFactor = glm::vec4(glm::vec3(m.baseColorFactor) * glm::mix(1.0f, kDarkest, porous), m.baseColorFactor.a);
    const float factor = glm::mix(1.0f, kSmoothest, wetness);
    m.roughnessFactor *= factor;
    if (!m.reflectanceWidth) continue;
    const bool exponent = hasExponent(m.reflectance);
    m.reflectanceWidth = glm::vec2(smoother(m.reflectanceWidth->x, exponent, factor * factor), smoother(m.reflectanceWidth->y, exponent, factor * factor));
  }
  return wet;
}

std::vector<Material> animated(MaterialAnimation animation, const std::vector<Material>& materials, double seconds) {
  return animation == MaterialAnimation::wetness ? wetMaterials(materials, wetnessAt(seconds)) : materials;
}

}  // namespace chiaro
