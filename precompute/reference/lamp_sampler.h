#pragma once
/// A light of the scene as one surface point sees it: the radiance along a direction, and directions towards it.

#include <glm/glm.hpp>

#include "assets/scene/scene.h"

namespace chiaro::reference {

/// Lights, KHR_lights_punctual's range and cone included, as Light defines them. Written apart from shaders/lobe on purpose.
class LampSampler {
 public:
  LampSampler(const Light& light, glm::dvec3 position);

  /// No larger than rounding: one direction, and irradiance() instead of radiance.
  bool isPoint() const { return point_; }
  glm::dvec3 direction() const { return axis_; }      ///< unit, to its middle
  double distance() const { return distance_; }       ///< of its middle; infinite for a sun
  glm::dvec3 irradiance() const { return irradiance_; }  ///< of a point, on a surface that faces it

  struct Seen {
    glm::dvec3 radiance{0.0};
    double density = 0.0;   ///< of sample(), per steradian
    double distance = 0.0;
  };
  /// Of a light with a size; zero where the direction misses it.
  Seen at(glm::dvec3 wi) const;
  /// Sphere and sun: uniform in solid angle. Disk: uniform in area.
  glm::dvec3 sample(glm::dvec2 random) const;

 private:
  void asSun(const Light& light);
  void asSphere(const Light& light);
  void asDisk(const Light& light);
  double coneOf(double cosine) const;
  glm::dvec3 world(glm::dvec3 local) const { return x_ * local.x + y_ * local.y + axis_ * local.z; }

  LightType type_;
  bool point_ = true;
  glm::dvec3 offset_{0.0};     ///< to the middle
  glm::dvec3 way_;             ///< the way the light travels
  glm::dvec3 axis_{0.0, 1.0, 0.0}, x_{1.0, 0.0, 0.0}, y_{0.0, 0.0, 1.0};  ///< of the cap (sphere, sun)
  double distance_ = 0.0, radius_ = 0.0;
  double sine_ = 0.0;          ///< of the cap's half-angle
  double versine_ = 0.0;       ///< 1 - its cosine; 2 inside a sphere
  double outerCosine_ = -1.0, coneWidth_ = 1.0;
  glm::dvec3 irradiance_{0.0};
  glm::dvec3 radiance_{0.0};
};

}  // namespace chiaro::reference
