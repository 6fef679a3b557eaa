// Visibility from a spherical signed distance function (Wang et al. 2009): the share of an SG lobe that a vertex sees.
#ifndef CHIARO_CPP
#include "shaders/lobe/half_space.glsl"
#endif

// distance: the SSDF at the lobe's axis, radians, positive where the axis is visible; beyond +-pi/2 it is taken as +-pi/2 (a
// half-space cannot be farther). Returns [0, 1]; sharpness as in sgHalfSpaceFraction.
// Against ray-traced visibility the half-space picture errs by .10 rms at sharpness 10, .017 at 1000 (ALGORITHMS 3.3).
FN Real ssdfVisibleFraction(IN(Real) distance, IN(Real) sharpness) {
  Real d = clampReal(distance, -kHalfPi, kHalfPi);
  Real halfComplement = sinQuarter(Real(0.5) * (kHalfPi - abs(d)));
  Real far = halfSpaceFractionFarSide(sinQuarter(abs(d)), Real(2.0) * halfComplement * halfComplement, sharpness);
  return d < Real(0.0) ? far : Real(1.0) - far;
}
