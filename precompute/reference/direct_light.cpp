#include "precompute/reference/direct_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "precompute/reference/lamp_sampler.h"
#include "precompute/reference/reflection_sampler.h"

namespace chiaro::reference {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The environment as a light that can be drawn from.
class Sky {
 public:
  explicit Sky(const EnvironmentSampler& environment) : environment_(environment) {}
  bool any() const { return environment_.anyLight(); }
  glm::dvec3 sample(glm::dvec2 random) const { return environment_.sample(random); }
  LampSampler::Seen at(glm::dvec3 wi) const {
    const EnvironmentSampler::Light light = environment_.at(wi);
    return {light.radiance, light.density, std::numeric_limits<double>::infinity()};
  }

 private:
  const EnvironmentSampler& environment_;
};

class Lamp {
 public:
  Lamp(const Light& light, glm::dvec3 position) : sampler_(light, position) {}
  bool any() const { return true; }
  glm::dvec3 sample(glm::dvec2 random) const { return sampler_.sample(random); }
  LampSampler::Seen at(glm::dvec3 wi) const { return sampler_.at(wi); }
  const LampSampler& sampler() const { return sampler_; }

 private:
  LampSampler sampler_;
};

/// True where something hides what lies `distance` away along wi. A lamp may sit on a surface: its own does not hide it.
bool hidden(const Surface& surface, glm::dvec3 wi, double distance, const RayScene& rays) {
  const glm::vec3 position(surface.position);
  const float offset = rays.surfaceOffset(position);
  const glm::vec3 origin = position + offset * glm::vec3(surface.geometricNormal);
  return rays.occluded(origin, glm::vec3(wi), 0.0f, std::isfinite(distance) ? static_cast<float>(distance) - 2.0f * offset : kInfinity);
}

/// Draws and weighs directions for one surface point, viewer and light.
template <class Source>
class LightGatherer {
 public:
  LightGatherer(const Surface& surface, glm::dvec3 wo, const Source& light, const RayScene* rays, Strategy strategy)
      : surface_(surface),
        wo_(wo * surface.worldFromTangent),
        light_(light),
        rays_(rays),
        sampler_(surface.brdf, wo_,
                 strategy == Strategy::reflection ? 1.0
                 : strategy == Strategy::cosine   ? 0.0
                                                  : reflectionShare(surface.brdf, wo_),
                 strategy == Strategy::combined ? coatShare(surface.brdf, wo_) : 0.0) {
    useLight_ = light.any() && (strategy == Strategy::combined || strategy == Strategy::light);
    useBrdf_ = strategy != Strategy::light;
  }

  /// One sample of the radiance towards the viewer.
  glm::dvec3 draw(const PointSet& points, std::uint32_t index) {
    glm::dvec3 sum(0.0);
    if (useLight_) {
      const glm::dvec3 wi = light_.sample(points.pair(index, 0));
      sum += contribution(wi, wi * surface_.worldFromTangent);
    }
    if (useBrdf_) {
      const glm::dvec3 local = sampler_.sample(points.single(index, 2), points.pair(index, 1));
      sum += contribution(surface_.worldFromTangent * local, local);
    }
    return sum;
  }

  std::uint64_t rays() const { return rayCount_; }

 private:
  /// The integrand over the sum of all densities: the balance heuristic. `wi` in the world, `local` in the tangent frame.
  glm::dvec3 contribution(glm::dvec3 wi, glm::dvec3 local) {
    const glm::dvec3 none(0.0);
    if (!(glm::dot(surface_.interpolatedNormal, wi) > 0.0)) return none;
    const glm::dvec3 reflected = brdfTimesCosine(surface_.brdf, wo_, local);
    if (!(reflected.x + reflected.y + reflected.z > 0.0)) return none;
    const LampSampler::Seen light = light_.at(wi);
    const glm::dvec3 value = reflected * light.radiance;
    if (!(value.x + value.y + value.z > 0.0)) return none;
    double density = useLight_ ? light.density : 0.0;
    if (useBrdf_) density += sampler_.density(local);
    if (!(density > 0.0)) return none;
    if (rays_ != nullptr) {
      ++rayCount_;
      if (hidden(surface_, wi, light.distance, *rays_)) return none;
    }
    return value / density;
  }

  const Surface& surface_;
  glm::dvec3 wo_;  ///< in the tangent frame
  const Source& light_;
  const RayScene* rays_;
  ReflectionSampler sampler_;
  bool useLight_ = true;
  bool useBrdf_ = true;
  std::uint64_t rayCount_ = 0;
};

template <class Source>
Estimate estimate(const Surface& surface, glm::dvec3 wo, const Source& light, const RayScene* rays, int samples, std::uint32_t seed,
                  Strategy strategy) {
  LightGatherer<Source> gatherer(surface, wo, light, rays, strategy);
  // Few, as larger sets are more even; enough to know their variance.
  const int sets = std::min(samples, std::clamp(samples / 16, 4, 8));
  const int setSize = (samples + sets - 1) / sets;
  Estimate estimate;
  glm::dvec3 squares(0.0);
  for (int set = 0; set < sets; ++set) {
    const PointSet points(hashWords(seed, static_cast<std::uint32_t>(set)));
    glm::dvec3 sum(0.0);
    for (int i = 0; i < setSize; ++i) sum += gatherer.draw(points, static_cast<std::uint32_t>(i));
    sum /= setSize;
    // Welford's update: no cancellation where the sets nearly agree.
    const glm::dvec3 delta = sum - estimate.mean;
    estimate.mean += delta / (set + 1.0);
    squares += delta * (sum - estimate.mean);
  }
  estimate.varianceOfMean = squares / (static_cast<double>(sets) * (sets - 1));
  estimate.rays = gatherer.rays();
  return estimate;
}

Estimate pointLight(const Surface& surface, glm::dvec3 wo, const LampSampler& lamp, const RayScene* rays) {
  Estimate estimate;
  const glm::dvec3 wi = lamp.direction();
  if (!(glm::dot(surface.interpolatedNormal, wi) > 0.0)) return estimate;
  const glm::dvec3 light =
      brdfTimesCosine(surface.brdf, wo * surface.worldFromTangent, wi * surface.worldFromTangent) * lamp.irradiance();
  if (!(light.x + light.y + light.z > 0.0)) return estimate;
  if (rays != nullptr) {
    ++estimate.rays;
    if (hidden(surface, wi, lamp.distance(), *rays)) return estimate;
  }
  estimate.mean = light;
  return estimate;
}

}  // namespace

Estimate environmentLight(const Surface& surface, glm::dvec3 wo, const EnvironmentSampler& environment, const RayScene* rays,
                          int samples, std::uint32_t seed, Strategy strategy) {
  return estimate(surface, wo, Sky(environment), rays, samples, seed, strategy);
}

Estimate lampLight(const Surface& surface, glm::dvec3 wo, const std::vector<Light>& lights, const RayScene* rays, int samples,
                   std::uint32_t seed, Strategy strategy) {
  Estimate all;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Lamp lamp(lights[l], surface.position);
    const Estimate one = lamp.sampler().isPoint() ? pointLight(surface, wo, lamp.sampler(), rays)
                                                  : estimate(surface, wo, lamp, rays, samples, hashWords(seed, 1000u + static_cast<std::uint32_t>(l)), strategy);
    all.mean += one.mean;
    all.varianceOfMean += one.varianceOfMean;
    all.rays += one.rays;
  }
  return all;
}

}  // namespace chiaro::reference
