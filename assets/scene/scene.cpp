#include "assets/scene/scene.h"

#include <algorithm>
#include <cmath>

namespace chiaro {
namespace {

constexpr float kSmallest = 1e-15f;  // metres; keeps a camera before a scene that is a point from becoming nothing

}  // namespace

std::size_t Scene::vertexCount() const {
  std::size_t count = 0;
  for (const auto& primitive : primitives) count += primitive.positions.size();
  return count;
}

std::size_t Scene::triangleCount() const {
  std::size_t count = 0;
  for (const auto& primitive : primitives) count += primitive.triangleCount();
  return count;
}

const Material& materialOf(const Scene& scene, const Primitive& primitive) {
  static const Material kDefault{};
  return primitive.material == kNone ? kDefault : scene.materials[static_cast<std::size_t>(primitive.material)];
}

glm::vec2 reflectanceAlpha(const Material& material) {
  glm::vec2 alpha(material.roughnessFactor * material.roughnessFactor);
  if (material.reflectanceWidth) {
    alpha = *material.reflectanceWidth;
    if (hasExponent(material.reflectance)) alpha = {alphaFromExponent(alpha.x), alphaFromExponent(alpha.y)};
  } else {
    alpha.x = glm::mix(alpha.x, 1.0f, material.anisotropyStrength * material.anisotropyStrength);
  }
  if (isRound(material.reflectance)) alpha = glm::vec2(material.reflectanceWidth ? alpha.x : alpha.y);
  return alpha;
}

float dielectricF0(float ior) {
  if (ior == 0.0f) return 1.0f;
  const float root = (ior - 1.0f) / (ior + 1.0f);
  return root * root;
}

glm::mat2 TextureTransform::linear() const {
  const float c = std::cos(rotation), s = std::sin(rotation);
  return {glm::vec2(c, -s) * scale.x, glm::vec2(s, c) * scale.y};
}

Bounds boundsOf(const Scene& scene) {
  Bounds bounds;
  for (const auto& primitive : scene.primitives) {
    for (const auto index : primitive.indices) bounds.include(primitive.positions[index]);
  }
  return bounds;
}

Camera lookAt(glm::vec3 eye, glm::vec3 target, float verticalFov, const Bounds& bounds) {
  const glm::vec3 back = glm::normalize(eye - target);
  const glm::vec3 up = std::abs(back.y) > 0.999f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(up, back));
  Camera camera;
  camera.worldFromCamera =
      glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(eye, 1));
  camera.verticalFov = verticalFov;
  const float radius = 0.5f * bounds.diagonal();
  const float distance = glm::length(eye - bounds.center());
  camera.farPlane = std::max(distance + 1.1f * radius, kSmallest);
  camera.nearPlane = std::max(distance - 1.1f * radius, 1e-3f * camera.farPlane);
  return camera;
}

Camera defaultCamera(const Scene& scene, float aspect) {
  if (!scene.cameras.empty()) return scene.cameras.front();
  const Bounds bounds = boundsOf(scene);
  const float fov = 0.7f;
  // The bounding sphere must fit the narrower of the two angles of view.
  const float half = std::atan(std::tan(0.5f * fov) * std::min(aspect, 1.0f));
  const float distance = 0.5f * std::max(bounds.diagonal(), kSmallest) / std::sin(half);
  const glm::vec3 towardsEye = glm::normalize(glm::vec3(0.5f, 0.45f, 1.0f));
  const glm::vec3 center = bounds.empty() ? glm::vec3(0) : bounds.center();
  return lookAt(center + distance * towardsEye, center, fov, bounds);
}

}  // namespace chiaro
