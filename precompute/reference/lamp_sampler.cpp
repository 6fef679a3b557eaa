#include "precompute/reference/lamp_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace chiaro::reference {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPointSine = 1e-7;  // of half-angles below, a direction's own rounding is no longer far below the light's size

void frameAbout(glm::dvec3 axis, glm::dvec3& x, glm::dvec3& y) {
  const glm::dvec3 helper = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  x = glm::normalize(glm::cross(helper, axis));
  y = glm::cross(axis, x);
}

}  // namespace

LampSampler::LampSampler(const Light& light, glm::dvec3 position) : type_(light.type), way_(glm::normalize(glm::dvec3(light.direction))) {
  const glm::dvec3 intensity = static_cast<double>(light.intensity) * glm::dvec3(light.color);
  if (type_ == LightType::directional) {
    irradiance_ = intensity;
    asSun(light);
    return;
  }
  offset_ = glm::dvec3(light.position) - position;
  distance_ = glm::length(offset_);
  if (distance_ > 0.0) axis_ = offset_ / distance_;
  frameAbout(axis_, x_, y_);
  const double reach = distance_ / static_cast<double>(light.range);
  irradiance_ = intensity * std::clamp(1.0 - reach * reach * reach * reach, 0.0, 1.0);
  if (type_ == LightType::spot || type_ == LightType::disk) {
    outerCosine_ = std::cos(static_cast<double>(light.outerConeAngle));
    coneWidth_ = std::max(0.001, std::cos(static_cast<double>(light.innerConeAngle)) - outerCosine_);
  }
  if (type_ == LightType::sphere) asSphere(light);
  if (type_ == LightType::disk) asDisk(light);
  if (!point_) return;
  const double cosine = glm::dot(way_, -axis_);
  if (type_ == LightType::spot) irradiance_ *= coneOf(cosine);
  if (type_ == LightType::disk) irradiance_ *= std::max(cosine, 0.0) * coneOf(cosine);
  irradiance_ /= distance_ * distance_;
}

void LampSampler::asSun(const Light& light) {
  axis_ = -way_;
  frameAbout(axis_, x_, y_);
  distance_ = std::numeric_limits<double>::infinity();
  const double angle = std::clamp(static_cast<double>(light.angle), 0.0, 0.5 * kPi);
  sine_ = std::sin(angle);
  point_ = !(sine_ > kPointSine);
  if (point_) return;
  versine_ = 2.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle);
  radiance_ = irradiance_ / (kPi * sine_ * sine_);
}

void LampSampler::asSphere(const Light& light) {
  radius_ = static_cast<double>(light.radius);
  const bool inside = distance_ < radius_;
  sine_ = inside ? 1.0 : radius_ / distance_;
  point_ = !(sine_ > kPointSine);
  if (point_) return;
  versine_ = inside ? 2.0 : sine_ * sine_ / (1.0 + std::sqrt((1.0 - sine_) * (1.0 + sine_)));
  radiance_ = irradiance_ / (kPi * radius_ * radius_);
}

void LampSampler::asDisk(const Light& light) {
  radius_ = static_cast<double>(light.radius);
  point_ = !(radius_ > kPointSine * distance_);
  if (point_) return;
  frameAbout(way_, x_, y_);  // across the disk
  radiance_ = irradiance_ / (kPi * radius_ * radius_);
}

/// KHR_lights_punctual: of a direction's cosine with the light's.
double LampSampler::coneOf(double cosine) const {
  const double edge = std::clamp((cosine - outerCosine_) / coneWidth_, 0.0, 1.0);
  return edge * edge;
}

LampSampler::Seen LampSampler::at(glm::dvec3 wi) const {
  constexpr double kRounding = 1e-8;  // a drawn direction on the rim is still on the light
  const Seen none;
  if (type_ == LightType::disk) {
    const double cosine = -glm::dot(wi, way_), height = -glm::dot(offset_, way_);
    if (!(cosine > 0.0 && height > 0.0)) return none;
    const double distance = height / cosine;
    if (!(glm::length(wi * distance - offset_) <= radius_ * (1.0 + kRounding))) return none;
    return {radiance_ * coneOf(cosine), distance * distance / (cosine * kPi * radius_ * radius_), distance};
  }
  const double density = 1.0 / (2.0 * kPi * versine_);
  if (type_ == LightType::directional) {
    const double along = glm::dot(wi, axis_);
    if (!(along > 0.0 && glm::length(wi - along * axis_) <= sine_ * (1.0 + kRounding))) return none;
    return {radiance_, density, distance_};
  }
  const double along = glm::dot(wi, offset_), aside = glm::length(offset_ - along * wi);
  const double half = std::sqrt(std::max(0.0, radius_ * radius_ - aside * aside));
  if (versine_ == 2.0) return {radiance_, density, along + half};
  if (!(along > 0.0 && aside <= radius_ * (1.0 + kRounding))) return none;
  return {radiance_, density, along - half};
}

glm::dvec3 LampSampler::sample(glm::dvec2 random) const {
  const double turn = 2.0 * kPi * random.y;
  if (type_ == LightType::disk) {
    const double r = radius_ * std::sqrt(random.x);
    return glm::normalize(offset_ + r * (std::cos(turn) * x_ + std::sin(turn) * y_));
  }
  const double versine = versine_ * random.x;
  const double sine = std::sqrt(versine * (2.0 - versine));
  return world({sine * std::cos(turn), sine * std::sin(turn), 1.0 - versine});
}

}  // namespace chiaro::reference
