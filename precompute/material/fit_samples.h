#pragma once
/// A reflectance as numbers on the grid of half and difference angles that the MERL files have.

#include <vector>

#include "precompute/material/measured_reflectance.h"

namespace chiaro {

/// One pair of directions.
struct FitSample {
  lobe64::Vec3 wo, wi;
  lobe64::Vec3 rho;      ///< 1/sr
  double fresnel = 0.0;  ///< (1 - wo.wh)^5
  double weight = 0.0;   ///< of d(wi) d(wo); all add up to 1
};

/// How many of the 90 steps of thetaDiff and the 180 of phiDiff are looked at, divisors of those; all 90 of thetaHalf are, as peaks are sharp in it.
struct FitGrid {
  int thetaDiff = 18;
  int phiDiff = 12;
};

/// Pairs whose directions are both at most `widest` radians from the normal and where `reflectance` says something (not NaN, not negative). Bins'
/// centres, each for its measure. Throws Error (unreadableInput), with `where`, when there are fewer than 100.
std::vector<FitSample> fitSamples(const ReflectanceFunction& reflectance, double widest, const FitGrid& grid, const std::string& where);

}  // namespace chiaro
