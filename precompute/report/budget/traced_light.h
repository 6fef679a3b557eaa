#pragma once
/// The light of an environment at one point of a surface, traced: exact answers to what the renderer's shading asks there (runtime/render/shading_tape.h).

#include <cstdint>
#include <optional>
#include <vector>

#include "precompute/embree/ray_scene.h"
#include "precompute/reference/environment_sampler.h"
#include "precompute/reference/surface.h"
#include "runtime/environment/sg_environment.h"

namespace chiaro {

struct TracedLightSettings {
  int raysPerLobe = 64;   ///< stratified over each lobe that is asked about
  int lightSamples = 256; ///< directions drawn from the environment, an even number, shared by all questions of the point
  std::uint32_t seed = 0;
};

/// For one thread.
class TracedLight {
 public:
  /// All arguments must outlive it. lights: those that the renderer takes apart from the rest of the environment, world space.
  TracedLight(const reference::Surface& surface, const RayScene& rays, const reference::EnvironmentSampler& environment, const std::vector<SgLight>& lights,
              const TracedLightSettings& settings);

  /// Share of the lobe that arrives, of what is above the horizon; nothing where next to none of it is above.
  std::optional<double> share(glm::vec3 axis, double sharpness);
  /// The same weighted by the cosine to the interpolated normal, as the vertices hold it.
  std::optional<double> cosineShare(glm::vec3 axis, double sharpness);
  /// Mean radiance under the normalised lobe, nothing hidden, above the horizon and below.
  glm::dvec3 mean(glm::vec3 axis, double sharpness);
  /// Mean of radiance times visibility over what of the lobe is above the shading normal's horizon; what is below the mesh's own is dark.
  std::optional<glm::dvec3> lobe(glm::vec3 axis, double sharpness);
  /// Of the surface, about its shading normal.
  glm::dvec3 irradiance();
  /// Cosine-weighted mean of (radiance - lights) times visibility over the lobe; nothing where next to none of it is above the horizon.
  std::optional<glm::dvec3> rest(glm::vec3 axis, double sharpness);

  /// Light towards a viewer by two reflectances at once, from the same directions: the exact one, and with Gaussians for its distribution (gaussianOverExact()).
  struct Reflected {
    glm::dvec3 exact{0.0}, gaussian{0.0};
  };
  /// half: 0 or 1, two estimates of independent directions, each from half the light samples and as many of the reflectance.
  Reflected reflected(glm::dvec3 wo, std::uint32_t half);

 private:
  struct Sample {
    glm::dvec3 direction;
    glm::dvec3 radiance;
    double density;  ///< of being drawn from the environment, per steradian
    bool free;
  };

  void aim(glm::vec3 axis, double sharpness, bool trace);
  Sample sampleAt(glm::dvec3 direction, bool free) const;
  glm::dvec3 withoutLights(const Sample& sample) const;
  template <class Value>
  glm::dvec3 lobeIntegral(glm::vec3 axis, double sharpness, Value value) const;

  const reference::Surface& surface_;
  const RayScene& rays_;
  const reference::EnvironmentSampler& environment_;
  const std::vector<SgLight>& lights_;
  TracedLightSettings settings_;
  glm::vec3 origin_, horizon_;
  std::vector<Sample> drawn_;            ///< from the environment
  std::vector<glm::vec3> directions_;    ///< of the lobe that was aimed at last
  std::vector<std::uint8_t> free_;
  std::uint32_t asked_ = 0;
};

}  // namespace chiaro
