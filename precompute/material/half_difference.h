#pragma once
/// Half and difference angles (Rusinkiewicz, A New Change of Variables for Efficient BRDF Representation, 1998; ALGORITHMS 2.6).

#include "shaders/cpp/lobe.h"

namespace chiaro {

/// Radians. The azimuth of the half vector is left out: round materials do not depend on it.
struct HalfDifference {
  double thetaHalf = 0.0;  ///< between the normal and the half vector, [0, pi/2]
  double thetaDiff = 0.0;  ///< between the half vector and either direction, [0, pi/2]
  double phiDiff = 0.0;    ///< of wi about the half vector, (-pi, pi]; exchanging wo and wi adds pi
};

HalfDifference halfDifference(const lobe64::Vec3& wo, const lobe64::Vec3& wi);

struct DirectionPair {
  lobe64::Vec3 wo, wi;  ///< unit; either may lie below the surface
};
/// A pair with these angles, its half vector in the xz plane.
DirectionPair directionPair(const HalfDifference& angles);

/// Of d(wi) d(wo), with the azimuth of the half vector integrated away, in thetaHalf, thetaDiff and phiDiff:
/// 8 pi cos(thetaDiff) sin(thetaDiff) sin(thetaHalf).
double halfDifferenceMeasure(const HalfDifference& angles);

}  // namespace chiaro
