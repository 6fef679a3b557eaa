#pragma once
/// The camera of the window, moved by the mouse: it starts as exactly the camera given and stays it until touched.

#include <glm/glm.hpp>

#include "assets/scene/scene.h"

namespace chiaro {

class OrbitCamera {
 public:
  OrbitCamera(const Camera& camera, const Bounds& bounds);

  const Camera& camera() const { return camera_; }
  glm::vec3 target() const { return target_; }
  float distance() const;

  /// Radians (orbited() in assets/scene/camera_spec.h).
  void orbit(float azimuth, float elevation);
  /// Moves the view so that what stands at the target's depth follows the pointer: offsets in pictures' heights, +y up.
  void pan(float right, float up);
  /// Steps towards the target (positive) or away: a step divides the distance by 1.1. Never reaches the target.
  void dolly(float steps);
  /// Vertical field of view in radians, 0.02..3; distance stays. No effect on an orthographic camera.
  void setVerticalFov(float radians);
  /// Holds the whole bounds in a frame of this width over height, from the present direction.
  void frame(float aspect);

 private:
  void moved();

  Camera camera_;
  Bounds bounds_;
  glm::vec3 target_;
};

}  // namespace chiaro
