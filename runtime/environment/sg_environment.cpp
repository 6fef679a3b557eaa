#include "runtime/environment/sg_environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "assets/error.h"
#include "runtime/environment/cube_map.h"
#include "runtime/environment/light_mixture.h"
#include "runtime/environment/prefilter.h"

namespace chiaro {
namespace {

void check(const Environment& environment, const SgEnvironmentSettings& settings) {
  const ImageRgb& map = environment.radiance;
  if (map.width <= 0 || map.height <= 0 ||
      map.texels.size() != static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height))
    throw inputError(environment.name, "the environment has no picture, or one whose size does not match",
                     "give an equirectangular image");
  for (const glm::vec3& texel : map.texels)
    if (!(texel.x >= 0 && texel.y >= 0 && texel.z >= 0 && texel.x + texel.y + texel.z <= 3e30f))
      throw inputError(environment.name, "the environment has a radiance that is negative, undefined or above 1e30", "clean the image");
  requireFinestResolution(settings.finestResolution, "finestResolution");
  if (!(settings.minLightSharpness > 0 && settings.minLightSharpness <= settings.maxLightSharpness &&
        settings.maxLightSharpness <= 1e8f))
    throw usageError("minLightSharpness", "the bounds of the light sharpness are not 0 < min <= max <= 1e8", "use 20 and 1e6");
}

}  // namespace

void requireFinestResolution(int resolution, const std::string& where) {
  if (resolution < 16 || resolution > 1024 || (resolution & (resolution - 1)) != 0)
    throw usageError(where, std::to_string(resolution) + " is no power of two from 16 to 1024", "use 512");
}

SgEnvironment prepareEnvironment(const Environment& environment, const SgEnvironmentSettings& settings) {
  check(environment, settings);
  SgEnvironment result;
  result.radiance = environment.radiance;
  result.lights = fitLights(environment.radiance, settings);
  result.pyramid = buildPyramid(analyse(environment.radiance, bandsOf(settings.finestResolution), settings.threads),
                                settings.finestResolution, settings.threads);
  return result;
}

float unfilteredSharpness(int equirectangularWidth) {
  const float texelsARadian = static_cast<float>(equirectangularWidth) / (2.0f * std::numbers::pi_v<float>);
  return 6.0f * texelsARadian * texelsARadian;
}

glm::vec3 samplePyramid(const SgPyramid& pyramid, glm::vec3 direction, float sharpness) {
  const int last = 2 * static_cast<int>(pyramid.layer0.size()) - 1;
  const float ratio = pyramid.finestSharpness / std::max(sharpness, 1e-20f);
  const float position = std::clamp(std::log2(ratio), 0.0f, static_cast<float>(last));
  const int finer = std::min(static_cast<int>(position), last - 1);
  const auto sample = [&](int index) {
    const PrefilteredLevel& level = (index % 2 == 0 ? pyramid.layer0 : pyramid.layer1)[static_cast<std::size_t>(index / 2)];
    return sampleCube(level.texels, level.faceResolution, direction);
  };
  return glm::mix(sample(finer), sample(finer + 1), position - static_cast<float>(finer));
}

}  // namespace chiaro
