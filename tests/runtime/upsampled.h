#pragma once
/// What tests of upsampled frames share.

#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <string>

#include "assets/builtin/environment.h"
#include "assets/scene/camera_spec.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/render/renderer.h"
#include "tests/runtime/unoccluded.h"

namespace chiaro {

inline constexpr int kSize = 64;

inline Material metal(float roughness) {
  Material m;
  m.roughnessFactor = roughness;
  m.metallicFactor = 1.0f;
  return m;
}

inline Material matte() {
  Material m;
  m.roughnessFactor = 1.0f;
  m.metallicFactor = 0.0f;
  return m;
}

/// Shines along -Z, onto what faces +Z.
inline Light headlight(float intensity = 3.0f) {
  Light light;
  light.intensity = intensity;
  return light;
}

inline RenderSettings upsampled(int cell, UpsampleWeights weights = UpsampleWeights::lobe, float recompute = 0.0f) {
  RenderSettings settings = smallPicture(kSize);
  settings.upsample = cell;
  settings.upsampleWeights = weights;
  settings.recompute = {.share = recompute, .milliseconds = 0.0f};
  return settings;
}

/// From a circle about the origin, `degrees` from +Z.
inline Camera around(const BakedScene& baked, float degrees) {
  const float a = degrees * 0.01745329252f;
  return lookAt({4.0f * std::sin(a), 0.5f, 4.0f * std::cos(a)}, {0, 0, 0}, 0.7f, boundsOf(baked.scene));
}

inline ImageRgba frame(Renderer& renderer, const Camera& camera, const RenderSettings& settings) {
  renderer.render(camera, settings);
  return renderer.readRadiance();
}

inline float largest(const ImageRgba& image) {
  float most = 0.0f;
  for (const auto& texel : image.texels)
    for (int c = 0; c < 3; ++c) most = texel[c] <= most ? most : texel[c];  // NaN becomes the most
  return most;
}

inline double rmse(const ImageRgba& a, const ImageRgba& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.texels.size(); ++i) {
    const glm::dvec3 difference(a.texels[i] - b.texels[i]);
    sum += glm::dot(difference, difference) / 3.0;
  }
  return std::sqrt(sum / static_cast<double>(a.texels.size()));
}

/// Prepared once.
inline const SgEnvironment& environment(const std::string& name) {
  static std::map<std::string, SgEnvironment> all;
  const auto found = all.find(name);
  return found != all.end() ? found->second : all.emplace(name, prepareEnvironment(loadEnvironment(name))).first->second;
}

}  // namespace chiaro
