#include "precompute/material/sgd_model.h"

#include <algorithm>
#include <cmath>

namespace chiaro {
namespace {

using lobe64::Vec3;

double shadowing(const SgdChannel& m, double cosine) {
  const double beyond = std::max(std::acos(std::min(cosine, 1.0)) - m.theta0, 0.0);
  // c and k reach 1e38 and 700: what overflows is a shadow.
  const double value = 1.0 + m.lambda * -std::expm1(m.c * std::pow(beyond, m.k));
  return value >= 0.0 ? std::min(value, 1.0) : 0.0;
}

double channel(const SgdChannel& m, double cosO, double cosI, double tan2Half, double cos2Half, double cosDiff) {
  const double x = m.alpha + tan2Half / m.alpha;
  const double d = m.kap * std::exp(-x) / (lobe64::kPi * std::pow(x, m.p) * cos2Half * cos2Half);
  const double f = m.f0 - m.f1 * cosDiff + (1.0 - m.f0) * lobe64::fresnelSchlickWeight(cosDiff);
  const double specular = m.rhoS * f * shadowing(m, cosO) * shadowing(m, cosI) * d / (cosO * cosI);
  return (m.rhoD + std::max(specular, 0.0)) / lobe64::kPi;
}

}  // namespace

ReflectanceFunction sgdReflectance(const std::array<SgdChannel, 3>& channels) {
  return [channels](const Vec3& wo, const Vec3& wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return Vec3(0.0);
    const Vec3 wh = lobe64::halfVector(wo, wi);
    const double cos2 = std::max(wh.z * wh.z, 1e-12), tan2 = (wh.x * wh.x + wh.y * wh.y) / cos2,
                 cosDiff = std::min(dot(wo, wh), 1.0);
    Vec3 rho(0.0);
    for (int c = 0; c < 3; ++c) rho[c] = channel(channels[static_cast<std::size_t>(c)], wo.z, wi.z, tan2, cos2, cosDiff);
    return rho;
  };
}

}  // namespace chiaro
