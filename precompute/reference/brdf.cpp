#include "precompute/reference/brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chiaro::reference {
namespace {

constexpr double kPi = std::numbers::pi;

double distribution(const Brdf& brdf, glm::dvec3 wh) {
  const double x = wh.x / brdf.alphaX;
  const double y = wh.y / brdf.alphaY;
  const double s = x * x + y * y + wh.z * wh.z;
  return 1.0 / (kPi * brdf.alphaX * brdf.alphaY * s * s);
}

/// |(alphaX x, alphaY y, z)| = z (1 + 2 Lambda(w)): Smith's masking without a division by z.
double stretched(const Brdf& brdf, glm::dvec3 w) { return std::hypot(brdf.alphaX * w.x, brdf.alphaY * w.y, w.z); }

double pow5(double x) { return x * x * x * x * x; }

glm::dvec3 fresnel(const Brdf& brdf, double cosine) {
  return brdf.f0 + (brdf.f90 - brdf.f0) * pow5(1.0 - std::clamp(cosine, 0.0, 1.0));
}

}  // namespace

glm::dvec3 brdfTimesCosine(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi) {
  if (!(wi.z > 0.0 && wo.z > 0.0)) return glm::dvec3(0.0);
  const glm::dvec3 wh = glm::normalize(wo + wi);
  const glm::dvec3 f = fresnel(brdf, glm::dot(wo, wh));
  // G / (4 wi.z wo.z) with G = 1 / (1 + Lambda(wo) + Lambda(wi))
  const double visibility = 0.5 / (wi.z * stretched(brdf, wo) + wo.z * stretched(brdf, wi));
  return (f * (distribution(brdf, wh) * visibility) + (1.0 - f) * brdf.diffuse / kPi) * wi.z;
}

glm::dvec3 sampleCosine(glm::dvec2 random) {
  const double radius = std::sqrt(random.x);
  const double angle = 2.0 * kPi * random.y;
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0, 1.0 - random.x))};
}

double cosineDensity(glm::dvec3 wi) { return std::max(wi.z, 0.0) / kPi; }

glm::dvec3 sampleReflection(const Brdf& brdf, glm::dvec3 wo, glm::dvec2 random) {
  // In the space where the surface is a hemisphere, its visible part is a half disc and a half ellipse seen along wo.
  const glm::dvec3 view = glm::normalize(glm::dvec3(brdf.alphaX * wo.x, brdf.alphaY * wo.y, wo.z));
  const double across = view.x * view.x + view.y * view.y;
  const glm::dvec3 first = across > 0.0 ? glm::dvec3(-view.y, view.x, 0.0) / std::sqrt(across) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 second = glm::cross(view, first);
  const double radius = std::sqrt(random.x);
  const double angle = 2.0 * kPi * random.y;
  const double a = radius * std::cos(angle);
  const double share = 0.5 * (1.0 + view.z);
  const double b = (1.0 - share) * std::sqrt(std::max(0.0, 1.0 - a * a)) + share * radius * std::sin(angle);
  const glm::dvec3 onSphere = a * first + b * second + std::sqrt(std::max(0.0, 1.0 - a * a - b * b)) * view;
  const glm::dvec3 wh = glm::normalize(glm::dvec3(brdf.alphaX * onSphere.x, brdf.alphaY * onSphere.y, std::max(onSphere.z, 0.0)));
  return glm::normalize(2.0 * glm::dot(wo, wh) * wh - wo);
}

double reflectionDensity(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi) {
  const glm::dvec3 sum = wo + wi;
  const double length = glm::length(sum);
  if (!(length > 0.0 && sum.z > 0.0)) return 0.0;
  // G1(wo) / wo.z = 2 / (wo.z + stretched(wo))
  return distribution(brdf, sum / length) / (2.0 * (wo.z + stretched(brdf, wo)));
}

double reflectionShare(const Brdf& brdf, glm::dvec3 wo) {
  const glm::dvec3 f = fresnel(brdf, wo.z);
  const double reflected = f.x + f.y + f.z;
  const glm::dvec3 scattered = (1.0 - f) * brdf.diffuse;
  const double total = reflected + scattered.x + scattered.y + scattered.z;
  if (!(total > reflected)) return 1.0;
  if (!(reflected > 0.0)) return 0.0;
  // Never all of one kind: at grazing angles or in the lobe's tail the other one is the better sampler.
  return std::clamp(reflected / total, 0.25, 0.9);
}

}  // namespace chiaro::reference
