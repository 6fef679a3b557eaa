#include "precompute/material/abc_model.h"

#include <algorithm>
#include <cmath>

namespace chiaro {

using lobe64::Vec3;

double dielectricFresnel(double cosine, double ior) {
  const double g2 = ior * ior - 1.0 + cosine * cosine;
  if (!(g2 > 0.0)) return 1.0;
  const double g = std::sqrt(g2), minus = g - cosine, plus = g + cosine;
  const double ratio = minus / plus, turn = (cosine * plus - 1.0) / (cosine * minus + 1.0);
  return 0.5 * ratio * ratio * (1.0 + turn * turn);
}

double grooveMasking(const Vec3& wo, const Vec3& wi, const Vec3& wh) {
  return std::min(1.0, 2.0 * wh.z * std::min(wo.z, wi.z) / std::max(dot(wo, wh), 1e-9));
}

ReflectanceFunction abcReflectance(const AbcModel& m) {
  return [m](const Vec3& wo, const Vec3& wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return Vec3(0.0);
    const Vec3 wh = lobe64::halfVector(wo, wi);
    // 1 - cos of the half angle without cancellation.
    const double versine = (wh.x * wh.x + wh.y * wh.y) / (1.0 + wh.z);
    const double d = std::pow(1.0 + m.b * versine, -m.c);
    const double smooth = dielectricFresnel(std::min(dot(wo, wh), 1.0), m.ior) * grooveMasking(wo, wi, wh) / (wo.z * wi.z);
    return (m.diffuse + m.a * (d * smooth)) / lobe64::kPi;
  };
}

}  // namespace chiaro
