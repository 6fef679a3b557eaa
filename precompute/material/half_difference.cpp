#include "precompute/material/half_difference.h"

#include <cmath>

namespace chiaro {

using lobe64::Vec3;

HalfDifference halfDifference(const Vec3& wo, const Vec3& wi) {
  const Vec3 wh = lobe64::halfVector(wo, wi);
  const double sine = std::hypot(wh.x, wh.y);
  HalfDifference angles;
  angles.thetaHalf = std::atan2(sine, wh.z);
  // The frame in which wh is the pole and the plane of n and wh is xz.
  const double cosPhi = sine > 0.0 ? wh.x / sine : 1.0, sinPhi = sine > 0.0 ? wh.y / sine : 0.0;
  const Vec3 x(wh.z * cosPhi, wh.z * sinPhi, -sine), y(-sinPhi, cosPhi, 0.0);
  const double dx = dot(wi, x), dy = dot(wi, y);
  angles.thetaDiff = std::atan2(std::hypot(dx, dy), dot(wi, wh));
  angles.phiDiff = std::atan2(dy, dx);
  return angles;
}

DirectionPair directionPair(const HalfDifference& a) {
  const double sh = std::sin(a.thetaHalf), ch = std::cos(a.thetaHalf), sd = std::sin(a.thetaDiff), cd = std::cos(a.thetaDiff);
  const double px = sd * std::cos(a.phiDiff), py = sd * std::sin(a.phiDiff);
  const auto turned = [&](double x, double y) { return Vec3(ch * x + sh * cd, y, ch * cd - sh * x); };
  return {.wo = turned(-px, -py), .wi = turned(px, py)};
}

double halfDifferenceMeasure(const HalfDifference& a) {
  return 8.0 * lobe64::kPi * std::cos(a.thetaDiff) * std::sin(a.thetaDiff) * std::sin(a.thetaHalf);
}

}  // namespace chiaro
