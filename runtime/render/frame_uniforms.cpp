#include "runtime/render/frame_uniforms.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace chiaro {
namespace {

constexpr unsigned kFlagShadows = 1, kFlagEnergyCompensation = 2;

/// Numbers of shaders/stage/lamps.glsl.
float typeNumber(LightType type) {
  switch (type) {
    case LightType::directional: return 0.0f;
    case LightType::point:
    case LightType::sphere: return 1.0f;
    case LightType::spot: return 2.0f;
    case LightType::disk: return 3.0f;
  }
  return 0.0f;
}

PunctualLightBlock blockOf(const Light& light, const glm::mat4& restFromWorld) {
  PunctualLightBlock block;
  block.positionType = glm::vec4(glm::vec3(restFromWorld * glm::vec4(light.position, 1.0f)), typeNumber(light.type));
  block.directionRange = glm::vec4(glm::mat3(restFromWorld) * light.direction, std::isfinite(light.range) && light.range > 0 ? 1.0f / light.range : 0.0f);
  const bool sized = light.type == LightType::sphere || light.type == LightType::disk;
  const float size = light.type == LightType::directional ? light.angle : sized ? light.radius : 0.0f;
  block.intensity = glm::vec4(light.color * light.intensity, size);
  // KHR_lights_punctual: clamp(cos * scale + offset)^2 between the outer and the inner cone.
  const float cosOuter = std::cos(light.outerConeAngle);
  const float scale = 1.0f / std::max(std::cos(light.innerConeAngle) - cosOuter, 1e-3f);
  block.cone = glm::vec4(scale, -cosOuter * scale, 0, 0);
  return block;
}

}  // namespace

glm::mat4 clipFromWorld(const Camera& camera, float aspect) {
  const float up = camera.verticalExtent, right = up * aspect;
  const glm::mat4 projection = camera.perspective ? glm::perspective(camera.verticalFov, aspect, camera.nearPlane, camera.farPlane)
                                                  : glm::ortho(-right, right, -up, up, camera.nearPlane, camera.farPlane);
  return projection * glm::inverse(camera.worldFromCamera);
}

FrameBlock frameBlock(const Camera& camera, const RenderSettings& settings, const GpuEnvironment& environment, const GpuScene& scene,
                      const std::vector<Light>& lights, const glm::mat4& worldFromRest) {
  FrameBlock frame;
  const glm::mat4 restFromWorld = glm::inverse(worldFromRest);
  const glm::mat4 restFromCamera = restFromWorld * camera.worldFromCamera;
  frame.clipFromWorld = clipFromWorld(camera, static_cast<float>(settings.width) / static_cast<float>(settings.height)) * worldFromRest;
  frame.worldFromClip = glm::inverse(frame.clipFromWorld);
  frame.eye = camera.perspective ? glm::vec4(glm::vec3(restFromCamera[3]), 1.0f) : glm::vec4(glm::normalize(glm::vec3(restFromCamera[2])), 0.0f);
  environment.fill(frame, glm::mat3(restFromWorld) * settings.worldFromEnvironment, scene.directions(), scene.directionSharpness());
  frame.counts.y = static_cast<int>(lights.size());
  frame.counts.z = static_cast<int>(settings.debugView);
  frame.counts.w = static_cast<int>((settings.shadows ? kFlagShadows : 0u) | (settings.energyCompensation ? kFlagEnergyCompensation : 0u));
  for (std::size_t l = 0; l < lights.size(); ++l) frame.punctualLights[l] = blockOf(lights[l], restFromWorld);
  return frame;
}

}  // namespace chiaro
