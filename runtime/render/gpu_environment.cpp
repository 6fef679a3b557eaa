#include "runtime/render/gpu_environment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "assets/error.h"
#include "assets/image/image.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

/// Projection on the first 25 harmonics, texel by texel, weighted by exact solid angles.
std::array<glm::vec3, 25> projectSh(const ImageRgb& map) {
  std::array<glm::dvec3, 25> sum{};
  for (int y = 0; y < map.height; ++y) {
    const double top = lobe64::kPi * y / map.height, bottom = lobe64::kPi * (y + 1) / map.height;
    const double solidAngle = (std::cos(top) - std::cos(bottom)) * lobe64::kTwoPi / map.width;
    for (int x = 0; x < map.width; ++x) {
      const auto direction = lobe64::directionFromEquirect({(x + 0.5) / map.width, (y + 0.5) / map.height});
      double basis[25];
      lobe64::shEvaluate(direction, basis);
      const glm::dvec3 radiance = glm::dvec3(map.at(x, y)) * solidAngle;
      for (std::size_t i = 0; i < 25; ++i) sum[i] += radiance * basis[i];
    }
  }
  std::array<glm::vec3, 25> result{};
  for (std::size_t i = 0; i < 25; ++i) result[i] = glm::vec3(sum[i]);
  return result;
}

int bandOf(std::size_t index) { return static_cast<int>(std::sqrt(static_cast<double>(index) + 0.5)); }

/// Mean of P_l over a normalised SG, l = 0..4: I_{l+1/2}(s) / I_{1/2}(s), by the upward recurrence rho_{l+1} = rho_{l-1} - (2l+1)/s rho_l,
/// which loses digits for small s; lights are sharp.
std::array<double, 5> bandScales(double sharpness) {
  std::array<double, 5> rho{1.0, lobe64::vmfMeanCosine(sharpness), 0, 0, 0};
  for (std::size_t l = 1; l + 1 < rho.size(); ++l) rho[l + 1] = rho[l - 1] - (2.0 * static_cast<double>(l) + 1.0) / sharpness * rho[l];
  return rho;
}

/// Mean radiance of one light under a normalised lobe (shade.glsl, lightMean).
glm::vec3 lightMean(const SgLight& light, glm::vec3 axis, float sharpness) {
  const auto product = lobe32::sgProductLog(axis, sharpness, light.axis, light.sharpness);
  return light.amplitude * (std::exp(product.amplitude) * lobe32::oneMinusExpOver(2.0f * product.sharpness) / lobe32::oneMinusExpOver(2.0f * sharpness));
}

}  // namespace

GpuEnvironment::GpuEnvironment(const SgEnvironment& environment) {
  const SgPyramid& pyramid = environment.pyramid;
  if (pyramid.layer0.empty() || pyramid.layer0.size() != pyramid.layer1.size() || environment.radiance.texels.empty())
    throw Error(ExitCode::failed, "environment", "is not prepared", "call prepareEnvironment first");
  source_.lights = environment.lights;
  if (source_.lights.size() > kMaxSgLights) source_.lights.resize(kMaxSgLights);
  source_.pyramid = pyramid;

  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const ImageRgb& map = environment.radiance;
  if (map.width > limit || map.height > limit)
    throw Error(ExitCode::failed, "OpenGL", "the environment is larger than the driver's " + std::to_string(limit) + " texels a side", "scale it down");
  radiance_ = gl::Texture::make2d(GL_RGB32F, map.width, map.height);
  radiance_.upload(0, GL_RGB, GL_FLOAT, map.texels.data());
  radiance_.filter(GL_LINEAR, GL_LINEAR);
  radiance_.wrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
  mapSharpness_ = std::max(unfilteredSharpness(map.width), 2.0f * pyramid.finestSharpness);

  const int levels = static_cast<int>(pyramid.layer0.size());
  pyramid_ = gl::Texture::makeCubeArray(GL_RGBA32F, pyramid.finestResolution, 2, levels);
  for (int level = 0; level < levels; ++level) {
    std::vector<glm::vec3> texels = pyramid.layer0[static_cast<std::size_t>(level)].texels;
    const auto& second = pyramid.layer1[static_cast<std::size_t>(level)].texels;
    texels.insert(texels.end(), second.begin(), second.end());
    pyramid_.upload(level, GL_RGB, GL_FLOAT, texels.data());
    bytes_ += texels.size() * 16;
  }
  pyramid_.filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
  bytes_ += map.texels.size() * sizeof(glm::vec3);

  restRadianceSh_ = projectSh(map);
  meanRadiance_ = static_cast<float>(luminance(restRadianceSh_[0]) / std::sqrt(4.0 * lobe64::kPi));  // the constant harmonic is 1 / sqrt(4 pi)
  for (const auto& light : source_.lights) {
    const auto scales = bandScales(light.sharpness);
    float basis[25];
    lobe32::shEvaluate(light.axis, basis);
    const glm::vec3 flux = light.amplitude * lobe32::sgUnitIntegral(light.sharpness);
    for (std::size_t i = 0; i < 25; ++i)
      restRadianceSh_[i] -= flux * (basis[i] * static_cast<float>(scales[static_cast<std::size_t>(bandOf(i))]));
  }
}

void GpuEnvironment::bindTextures() const {
  pyramid_.bind(5);
  radiance_.bind(6);
}

void GpuEnvironment::fill(FrameBlock& frame, const glm::mat3& worldFromEnvironment, const std::vector<glm::vec3>& directions,
                          float directionSharpness) const {
  const glm::mat3 environmentFromWorld = glm::transpose(worldFromEnvironment);
  frame.environmentFromWorld = glm::mat4(environmentFromWorld);
  frame.counts.x = static_cast<int>(source_.lights.size());
  for (std::size_t l = 0; l < source_.lights.size(); ++l) {
    frame.sgLights[l].axisSharpness = glm::vec4(worldFromEnvironment * source_.lights[l].axis, source_.lights[l].sharpness);
    frame.sgLights[l].amplitude = glm::vec4(source_.lights[l].amplitude, 0.0f);
  }
  frame.pyramid = glm::vec4(std::log2(source_.pyramid.finestSharpness), static_cast<float>(2 * source_.pyramid.layer0.size() - 1),
                            std::log2(mapSharpness_), directionSharpness);
  for (std::size_t j = 0; j < directions.size(); ++j) {
    const glm::vec3 axis = environmentFromWorld * directions[j];
    glm::vec3 rest = samplePyramid(source_.pyramid, axis, directionSharpness);
    for (const auto& light : source_.lights) rest -= lightMean(light, axis, directionSharpness);
    frame.restRadiance[j] = glm::vec4(rest, 0.0f);
    frame.directions[j] = glm::vec4(directions[j], 0.0f);
  }
  // The harmonics of the rotated rest, from its values along enough world directions: exact for bands up to 4.
  constexpr int kSamples = 512;
  for (auto& value : frame.irradiance) value = glm::vec4(0.0f);
  for (int i = 0; i < kSamples; ++i) {
    const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / kSamples;
    const float phi = static_cast<float>(i) * 2.39996323f;
    const float s = std::sqrt(1.0f - z * z);
    const glm::vec3 world(s * std::cos(phi), s * std::sin(phi), z);
    float local[25], basis[25];
    lobe32::shEvaluate(environmentFromWorld * world, local);
    lobe32::shEvaluate(world, basis);
    glm::vec3 value(0.0f);
    for (std::size_t k = 0; k < 25; ++k) value += restRadianceSh_[k] * local[k];
    for (std::size_t k = 0; k < 25; ++k)
      frame.irradiance[k] += glm::vec4(value, 0.0f) * (basis[k] * lobe32::shProjectionWeight(kSamples) * lobe32::shClampedCosine(bandOf(k)));
  }
}

}  // namespace chiaro
