#include "runtime/viewer/orbit_camera.h"

#include <algorithm>
#include <cmath>

#include "assets/scene/camera_spec.h"

namespace chiaro {
namespace {

constexpr float kSmallest = 1e-15f;  // metres, for a scene that is a point

glm::vec3 column(const Camera& camera, int i) { return glm::vec3(camera.worldFromCamera[i]); }

}  // namespace

OrbitCamera::OrbitCamera(const Camera& camera, const Bounds& bounds)
    : camera_(camera), bounds_(bounds), target_(orbitTarget(camera, bounds)) {}

float OrbitCamera::distance() const { return glm::length(column(camera_, 3) - target_); }

void OrbitCamera::orbit(float azimuth, float elevation) {
  camera_ = orbited(camera_, target_, azimuth, elevation);
  moved();
}

void OrbitCamera::pan(float right, float up) {
  const float height =
      camera_.perspective ? 2.0f * std::tan(0.5f * camera_.verticalFov) * distance() : 2.0f * camera_.verticalExtent;
  const glm::vec3 offset = -height * (right * column(camera_, 0) + up * column(camera_, 1));
  camera_.worldFromCamera[3] += glm::vec4(offset, 0.0f);
  target_ += offset;
  moved();
}

void OrbitCamera::dolly(float steps) {
  const float factor = std::pow(1.1f, -steps);
  const float smallest = std::max(1e-4f * bounds_.diagonal(), kSmallest);
  const float wanted = std::max(distance() * factor, smallest);
  if (!camera_.perspective) camera_.verticalExtent = std::max(camera_.verticalExtent * factor, smallest);
  if (camera_.perspective) camera_.worldFromCamera[3] = glm::vec4(target_ + wanted * column(camera_, 2), 1.0f);
  moved();
}

void OrbitCamera::setVerticalFov(float radians) { camera_.verticalFov = std::clamp(radians, 0.02f, 3.0f); }

void OrbitCamera::frame(float aspect) {
  const float radius = std::max(0.5f * bounds_.diagonal(), kSmallest);
  target_ = bounds_.empty() ? glm::vec3(0.0f) : bounds_.center();
  const float narrow = std::min(aspect, 1.0f);
  float away = 2.0f * radius;
  if (camera_.perspective) {
    // The bounding sphere must fit the narrower of the two angles of view.
    away = radius / std::sin(std::atan(std::tan(0.5f * camera_.verticalFov) * narrow));
  } else {
    camera_.verticalExtent = radius / narrow;
  }
  camera_.worldFromCamera[3] = glm::vec4(target_ + away * column(camera_, 2), 1.0f);
  moved();
}

void OrbitCamera::moved() { fitDepthRange(camera_, bounds_); }

}  // namespace chiaro
