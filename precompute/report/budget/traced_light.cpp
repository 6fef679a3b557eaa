#include "precompute/report/budget/traced_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "precompute/lobe_pattern.h"
#include "precompute/reference/reflection_sampler.h"
#include "precompute/reference/sampling.h"
#include "precompute/report/budget/gaussian_reflectance.h"
#include "precompute/traced_share.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using namespace reference;

/// Of a lobe, above the horizon: below it the renderer's own answer weighs nothing and stays.
constexpr double kLeastAbove = 1e-4;

/// Normalised lobe, per steradian; 1 - cosine from the chord, which keeps its accuracy for sharp lobes.
double lobeDensity(glm::dvec3 axis, double sharpness, glm::dvec3 direction) {
  const auto chord = direction - axis;
  return std::exp(-0.5 * sharpness * glm::dot(chord, chord)) / lobe64::sgUnitIntegral(sharpness);
}

}  // namespace

TracedLight::TracedLight(const Surface& surface, const RayScene& rays, const EnvironmentSampler& environment, const std::vector<SgLight>& lights,
                         const TracedLightSettings& settings)
    : surface_(surface), rays_(rays), environment_(environment), lights_(lights), settings_(settings), horizon_(surface.interpolatedNormal) {
  const glm::vec3 position(surface.position);
  origin_ = position + rays.surfaceOffset(position) * glm::vec3(surface.geometricNormal);
  if (!environment.anyLight()) return;
  for (std::uint32_t half = 0; half < 2; ++half) {
    const PointSet points(hashWords(settings.seed, half));
    for (int i = 0; i < settings.lightSamples / 2; ++i) directions_.emplace_back(environment.sample(points.pair(static_cast<std::uint32_t>(i), 0)));
  }
  tracedDirections(rays_, origin_, horizon_, directions_, free_);
  for (std::size_t i = 0; i < directions_.size(); ++i) drawn_.push_back(sampleAt(directions_[i], free_[i] != 0));
}

TracedLight::Sample TracedLight::sampleAt(glm::dvec3 direction, bool free) const {
  const auto light = environment_.at(direction);
  return {direction, light.radiance, light.density, free};
}

glm::dvec3 TracedLight::withoutLights(const Sample& sample) const {
  auto radiance = sample.radiance;
  for (const auto& light : lights_) {
    const auto chord = sample.direction - glm::dvec3(light.axis);
    radiance -= glm::dvec3(light.amplitude) * std::exp(-0.5 * static_cast<double>(light.sharpness) * glm::dot(chord, chord));
  }
  return radiance;
}

/// Fills directions_ with the lobe's, each question's turned by itself; trace: free_ too.
void TracedLight::aim(glm::vec3 axis, double sharpness, bool trace) {
  const double turn = 2.0 * lobe64::kPi * hashWords(settings_.seed, 2u + asked_++) * 0x1p-32;
  LobePattern(std::max(sharpness, 1e-3), static_cast<std::size_t>(settings_.raysPerLobe)).directions(axis, turn, directions_);
  if (trace) tracedDirections(rays_, origin_, horizon_, directions_, free_);
}

std::optional<double> TracedLight::share(glm::vec3 axis, double sharpness) {
  aim(axis, sharpness, true);
  std::size_t above = 0, seen = 0;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    above += glm::dot(directions_[i], horizon_) > 0.0f;
    seen += free_[i];
  }
  if (above == 0) return {};
  return static_cast<double>(seen) / static_cast<double>(above);
}

std::optional<double> TracedLight::cosineShare(glm::vec3 axis, double sharpness) {
  aim(axis, sharpness, true);
  double above = 0.0, seen = 0.0;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const double cosine = std::max(static_cast<double>(glm::dot(directions_[i], horizon_)), 0.0);
    above += cosine;
    seen += free_[i] != 0 ? cosine : 0.0;
  }
  if (!(above > 0.0)) return {};
  return seen / above;
}

/// Of lobe density times value(sample): by the lobe's own directions and those drawn from the environment (balance heuristic).
template <class Value>
glm::dvec3 TracedLight::lobeIntegral(glm::vec3 axis, double sharpness, Value value) const {
  const auto own = static_cast<double>(directions_.size()), drawn = static_cast<double>(drawn_.size());
  glm::dvec3 sum(0.0);
  const auto add = [&](const Sample& sample) {
    const double density = lobeDensity(axis, sharpness, sample.direction);
    if (density > 0.0) sum += value(sample) * (density / (own * density + drawn * sample.density));
  };
  for (std::size_t i = 0; i < directions_.size(); ++i) add(sampleAt(directions_[i], free_[i] != 0));
  for (const auto& sample : drawn_) add(sample);
  return sum;
}

glm::dvec3 TracedLight::mean(glm::vec3 axis, double sharpness) {
  aim(axis, sharpness, false);
  free_.assign(directions_.size(), 1);
  return lobeIntegral(axis, sharpness, [](const Sample& sample) { return sample.radiance; });
}

std::optional<glm::dvec3> TracedLight::lobe(glm::vec3 axis, double sharpness) {
  const auto& n = surface_.worldFromTangent[2];
  const double above = lobe64::sgHalfSpaceFraction(glm::dot(n, glm::dvec3(axis)), sharpness);
  if (!(above > kLeastAbove)) return {};
  aim(axis, sharpness, true);
  return lobeIntegral(axis, sharpness, [&](const Sample& sample) {
           return sample.free && glm::dot(n, sample.direction) > 0.0 ? sample.radiance : glm::dvec3(0.0);
         }) / above;
}

std::optional<glm::dvec3> TracedLight::rest(glm::vec3 axis, double sharpness) {
  const auto& n = surface_.worldFromTangent[2];
  const double above = lobe64::clampedCosineMean(glm::dot(n, glm::dvec3(axis)), sharpness);
  if (!(above > kLeastAbove)) return {};
  aim(axis, sharpness, true);
  return lobeIntegral(axis, sharpness, [&](const Sample& sample) {
           return sample.free ? withoutLights(sample) * std::max(glm::dot(n, sample.direction), 0.0) : glm::dvec3(0.0);
         }) / above;
}

glm::dvec3 TracedLight::irradiance() {
  const auto& n = surface_.worldFromTangent[2];
  const PointSet points(hashWords(settings_.seed, 2u + asked_++));
  directions_.clear();
  const auto count = static_cast<std::uint32_t>(settings_.lightSamples);
  for (std::uint32_t i = 0; i < count; ++i) directions_.emplace_back(surface_.worldFromTangent * sampleCosine(points.pair(i, 1)));
  tracedDirections(rays_, origin_, horizon_, directions_, free_);
  glm::dvec3 sum(0.0);
  const auto add = [&](const Sample& sample) {
    const double cosine = glm::dot(n, sample.direction);
    if (sample.free && cosine > 0.0) sum += sample.radiance * (cosine / (count * cosine / lobe64::kPi + static_cast<double>(drawn_.size()) * sample.density));
  };
  for (std::size_t i = 0; i < directions_.size(); ++i) add(sampleAt(directions_[i], free_[i] != 0));
  for (const auto& sample : drawn_) add(sample);
  return sum;
}

TracedLight::Reflected TracedLight::reflected(glm::dvec3 wo, std::uint32_t half) {
  const auto& brdf = surface_.brdf;
  const glm::dvec3 out = wo * surface_.worldFromTangent;
  const ReflectionSampler sampler(brdf, out, reflectionShare(brdf, out), coatShare(brdf, out));
  const PointSet points(hashWords(settings_.seed, 0x51ed270bu + half));
  const auto count = static_cast<std::uint32_t>(settings_.lightSamples / 2);
  directions_.clear();
  for (std::uint32_t i = 0; i < count; ++i)
    directions_.emplace_back(surface_.worldFromTangent * sampler.sample(points.single(i, 2), points.pair(i, 1)));
  tracedDirections(rays_, origin_, horizon_, directions_, free_);

  Brdf reflection = brdf;  // alone: what the Gaussians stand for
  reflection.diffuse = glm::dvec3(0.0);
  reflection.coat = 0.0;
  const double through = 1.0 - coatWeight(brdf, out);
  const std::size_t ownDrawn = drawn_.size() / 2, first = half * ownDrawn;
  Reflected sum;
  const auto add = [&](const Sample& sample) {
    if (!sample.free) return;
    const glm::dvec3 in = sample.direction * surface_.worldFromTangent;
    const auto exact = brdfTimesCosine(brdf, out, in);
    const double density = count * sampler.density(in) + static_cast<double>(ownDrawn) * sample.density;
    if (!(density > 0.0)) return;
    sum.exact += exact * sample.radiance / density;
    const auto changed = through * brdfTimesCosine(reflection, out, in) * (gaussianOverExact(brdf, out, in) - 1.0);
    sum.gaussian += (exact + changed) * sample.radiance / density;
  };
  for (std::size_t i = 0; i < directions_.size(); ++i) add(sampleAt(directions_[i], free_[i] != 0));
  for (std::size_t i = first; i < first + ownDrawn; ++i) add(drawn_[i]);
  return sum;
}

}  // namespace chiaro
