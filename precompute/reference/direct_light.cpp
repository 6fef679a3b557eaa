#include "precompute/reference/direct_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace chiaro::reference {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Draws and weighs directions for one surface point and viewer.
class LightGatherer {
 public:
  LightGatherer(const Surface& surface, glm::dvec3 wo, const EnvironmentSampler& environment, const RayScene* rays,
                Strategy strategy)
      : surface_(surface), wo_(wo * surface.worldFromTangent), environment_(environment), rays_(rays) {
    useEnvironment_ = environment.anyLight() && (strategy == Strategy::combined || strategy == Strategy::environment);
    useBrdf_ = strategy != Strategy::environment;
    reflectionShare_ = strategy == Strategy::reflection ? 1.0
                       : strategy == Strategy::cosine   ? 0.0
                                                        : reflectionShare(surface.brdf, wo_);
    coatShare_ = strategy == Strategy::combined ? coatShare(surface.brdf, wo_) : 0.0;
    reflectionShare_ *= 1.0 - coatShare_;
  }

  /// One sample of the radiance towards the viewer.
  glm::dvec3 draw(const PointSet& points, std::uint32_t index) {
    glm::dvec3 sum(0.0);
    if (useEnvironment_) {
      const glm::dvec3 wi = environment_.sample(points.pair(index, 0));
      sum += contribution(wi, wi * surface_.worldFromTangent);
    }
    if (useBrdf_) {
      const double choice = points.single(index, 2);
      const glm::dvec2 random = points.pair(index, 1);
      const glm::dvec3 local = choice < reflectionShare_                ? sampleReflection(surface_.brdf, wo_, random)
                               : choice < reflectionShare_ + coatShare_ ? sampleCoat(surface_.brdf, wo_, random)
                                                                        : sampleCosine(random);
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
    const EnvironmentSampler::Light light = environment_.at(wi);
    const glm::dvec3 value = reflected * light.radiance;
    if (!(value.x + value.y + value.z > 0.0)) return none;
    double density = useEnvironment_ ? light.density : 0.0;
    if (useBrdf_) {
      density +=
          reflectionShare_ * reflectionDensity(surface_.brdf, wo_, local) + (1.0 - reflectionShare_ - coatShare_) * cosineDensity(local);
      if (coatShare_ > 0.0) density += coatShare_ * coatDensity(surface_.brdf, wo_, local);
    }
    if (!(density > 0.0)) return none;
    if (rays_ != nullptr) {
      ++rayCount_;
      const glm::vec3 position(surface_.position);
      const glm::vec3 origin = position + rays_->surfaceOffset(position) * glm::vec3(surface_.geometricNormal);
      if (rays_->occluded(origin, glm::vec3(wi), 0.0f, kInfinity)) return none;
    }
    return value / density;
  }

  const Surface& surface_;
  glm::dvec3 wo_;  ///< in the tangent frame
  const EnvironmentSampler& environment_;
  const RayScene* rays_;
  double useEnvironment_ = 1.0;
  bool useBrdf_ = true;
  double reflectionShare_ = 0.5;
  double coatShare_ = 0.0;
  std::uint64_t rayCount_ = 0;
};

/// Irradiance at normal incidence from one light, the unit direction towards it, and how far it is.
struct Incident {
  glm::dvec3 wi{0.0, 1.0, 0.0};
  double distance = std::numeric_limits<double>::infinity();
  double attenuation = 1.0;
};

Incident incidentFrom(const Light& light, glm::dvec3 position) {
  Incident incident;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction));
  if (light.type == LightType::directional) {
    incident.wi = -axis;
    return incident;
  }
  const glm::dvec3 offset = glm::dvec3(light.position) - position;
  incident.distance = glm::length(offset);
  incident.wi = offset / incident.distance;
  incident.attenuation = 1.0 / (incident.distance * incident.distance);
  const double reach = incident.distance / static_cast<double>(light.range);
  incident.attenuation *= std::clamp(1.0 - reach * reach * reach * reach, 0.0, 1.0);
  if (light.type == LightType::spot) {
    const double inner = std::cos(static_cast<double>(light.innerConeAngle));
    const double outer = std::cos(static_cast<double>(light.outerConeAngle));
    const double edge = std::clamp((glm::dot(axis, -incident.wi) - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
    incident.attenuation *= edge * edge;
  }
  return incident;
}

}  // namespace

Estimate environmentLight(const Surface& surface, glm::dvec3 wo, const EnvironmentSampler& environment, const RayScene* rays,
                          int samples, std::uint32_t seed, Strategy strategy) {
  LightGatherer gatherer(surface, wo, environment, rays, strategy);
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

Estimate punctualLight(const Surface& surface, glm::dvec3 wo, const std::vector<Light>& lights, const RayScene* rays) {
  Estimate estimate;
  for (const Light& light : lights) {
    const Incident incident = incidentFrom(light, surface.position);
    if (!(incident.attenuation > 0.0 && glm::dot(surface.interpolatedNormal, incident.wi) > 0.0)) continue;
    const glm::dvec3 reflected =
        brdfTimesCosine(surface.brdf, wo * surface.worldFromTangent, incident.wi * surface.worldFromTangent);
    if (!(reflected.x + reflected.y + reflected.z > 0.0)) continue;
    if (rays != nullptr) {
      ++estimate.rays;
      const glm::vec3 position(surface.position);
      const float offset = rays->surfaceOffset(position);
      const glm::vec3 origin = position + offset * glm::vec3(surface.geometricNormal);
      // A lamp may sit on a surface: its own does not hide it.
      const auto reach = static_cast<float>(incident.distance) - 2.0f * offset;
      if (rays->occluded(origin, glm::vec3(incident.wi), 0.0f, reach)) continue;
    }
    estimate.mean += reflected * (incident.attenuation * static_cast<double>(light.intensity)) * glm::dvec3(light.color);
  }
  return estimate;
}

}  // namespace chiaro::reference
