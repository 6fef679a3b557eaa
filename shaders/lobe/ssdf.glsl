// Visibility from a spherical signed distance function (Wang et al. 2009): the share of an SG lobe that a vertex sees.
#ifndef CHIARO_CPP
#include "shaders/lobe/half_space.glsl"
#endif

// A distance as it is stored so that what compression loses falls where no lobe tells distances apart: softness * tanh(distance / softness), both in
// radians. The other way it is held within 3 softness, where float no longer tells stored values apart. softness > 0; 0 stores it as it is.
FN Real ssdfSoftened(IN(Real) distance, IN(Real) softness) {
  if (!(softness > Real(0.0))) return distance;
  Real e = exp(-Real(2.0) * min(abs(distance) / softness, Real(20.0)));
  Real t = softness * (Real(1.0) - e) / (Real(1.0) + e);
  return distance < Real(0.0) ? -t : t;
}

FN Real ssdfExpanded(IN(Real) stored, IN(Real) softness) {
  if (!(softness > Real(0.0))) return stored;
  Real t = min(abs(stored) / softness, Real(0.99505475));  // tanh(3)
  Real d = Real(0.5) * softness * log((Real(1.0) + t) / (Real(1.0) - t));
  return stored < Real(0.0) ? -d : d;
}

// distance: the SSDF at the lobe's axis, radians, positive where the axis is visible; beyond +-pi/2 it is taken as +-pi/2 (a
// half-space cannot be farther). Returns [0, 1]; sharpness as in sgHalfSpaceFraction.
// Against ray-traced visibility the half-space picture errs by .10 rms at sharpness 10, .017 at 1000 (ALGORITHMS 3.3).
FN Real ssdfVisibleFraction(IN(Real) distance, IN(Real) sharpness) {
  Real d = clampReal(distance, -kHalfPi, kHalfPi);
  Real halfComplement = sinQuarter(Real(0.5) * (kHalfPi - abs(d)));
  Real far = halfSpaceFractionFarSide(sinQuarter(abs(d)), Real(2.0) * halfComplement * halfComplement, sharpness);
  return d < Real(0.0) ? far : Real(1.0) - far;
}
