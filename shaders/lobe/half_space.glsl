// Integral of an SG over a half-space of directions. This is also the SSDF kernel f_h of Wang et al. 2009: the nearest
// visibility boundary, at signed angle theta from the lobe's axis (positive: the axis is visible), taken as a great circle.
//
// Our closed-form fit (ALGORITHMS 1.9): with s = sin(theta), l the sharpness,
//   t = l sqrt((.6328125 l + 2.16771) / (l^2 + 2.51737 l + 15.5371)),  q = s + b s (1 - s^2),
//   b = -(1/9) l^2 (l + 15.3483) / (l^3 + 8.00851 l^2 + 25.6846 l + 141.587),
//   fraction = 1/2 + 1/2 tanh(l/2) erf(t q) / erf(t).
// Largest error 3.4e-4 of the whole lobe over all l and theta (near l = 10); exact at theta = 0 and +-pi/2, and as l -> infinity.
// Below the axis (s < 0) it is evaluated through erfc, so that small fractions keep their relative accuracy.
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

// Fraction for the far side: s = -|s|, in (0, 1/2]. oneMinusSin = 1 - |s|, passed apart because it may be known better.
FN Real halfSpaceFractionFarSide(IN(Real) sinMagnitude, IN(Real) oneMinusSin, IN(Real) sharpness) {
  Real l = clampSharpness(sharpness);
  Real t2;
  Real b;
  if (l < Real(1.0)) {
    t2 = l * l * (Real(0.6328125) * l + Real(2.16771)) / ((l + Real(2.51737)) * l + Real(15.5371));
    b = -Real(1.0 / 9.0) * l * l * (l + Real(15.3483)) / (((l + Real(8.00851)) * l + Real(25.6846)) * l + Real(141.587));
  } else {  // the same in 1/l: cannot overflow, and rounds less where l is large
    Real r = Real(1.0) / l;
    t2 = l * (Real(0.6328125) + Real(2.16771) * r) / (Real(1.0) + r * (Real(2.51737) + r * Real(15.5371)));
    b = -Real(1.0 / 9.0) * (Real(1.0) + Real(15.3483) * r)
      / (Real(1.0) + r * (Real(8.00851) + r * (Real(25.6846) + r * Real(141.587))));
  }
  Real onePlusSin = Real(1.0) + sinMagnitude;
  Real q = sinMagnitude * (Real(1.0) + b * oneMinusSin * onePlusSin);
  Real e = exp(-l);
  if (t2 <= Real(1.0)) {
    Real ratio = q * erfOverArgument(t2 * q * q) / erfOverArgument(t2);
    return Real(0.5) - Real(0.5) * oneMinusExp(l) / (Real(1.0) + e) * ratio;
  }
  // erfc(t q) - erfc(t) with e^(-(t q)^2) taken out. Where the two nearly meet, the integral between them instead of their
  // difference: two Gauss points, relative error 1e-6 at a gap of 1/4.
  Real t = sqrt(t2);
  Real scaledAtT = erfcScaled(t);
  Real oneMinusQ = oneMinusSin * (Real(1.0) - b * sinMagnitude * onePlusSin);
  Real gap = t2 * oneMinusQ * (Real(1.0) + q);  // t^2 (1 - q^2)
  Real difference;
  if (gap < Real(0.25)) {
    Real from = t * q;
    Real x1 = t * oneMinusQ * kGaussPoint;
    Real x2 = t * oneMinusQ * (Real(1.0) - kGaussPoint);
    difference = t * oneMinusQ * kOneOverSqrtPi
               * (exp(-x1 * (Real(2.0) * from + x1)) + exp(-x2 * (Real(2.0) * from + x2)));
  } else {
    difference = (erfcScaled(t * q) - scaledAtT) + oneMinusExp(gap) * scaledAtT;
  }
  difference *= exp(-t2 * q * q);
  Real erfAtT = Real(1.0) - exp(-t2) * scaledAtT;
  return (e + Real(0.5) * (Real(1.0) - e) * difference / erfAtT) / (Real(1.0) + e);
}

// Share of the lobe inside the half-space, in [0, 1]. sinDistance = sin(theta), taken as clamped to [-1, 1]. Sharpness 0: 1/2 for every
// distance (half of the sphere); sharpness -> infinity: a step at 0, with 1/2 at 0.
FN Real sgHalfSpaceFraction(IN(Real) sinDistance, IN(Real) sharpness) {
  Real s = clampReal(sinDistance, -Real(1.0), Real(1.0));
  Real far = halfSpaceFractionFarSide(abs(s), Real(1.0) - abs(s), sharpness);
  return s < Real(0.0) ? far : Real(1.0) - far;
}

// f_h: the integral itself for amplitude 1, in sr.
FN Real sgHalfSpaceIntegral(IN(Real) sinDistance, IN(Real) sharpness) {
  return sgHalfSpaceFraction(sinDistance, sharpness) * kFourPi * oneMinusExpOver(Real(2.0) * clampSharpness(sharpness));
}
