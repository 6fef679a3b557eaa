// Constants and the special functions that the lobes are made of. GLSL leaves the precision of atan, acos, sin near its
// zeros and any erf to the driver (Mesa's atan is off by 2e-5), so those that matter are here, and the same on every machine.
#ifndef CHIARO_CPP
#include "shaders/lobe/dialect.glsl"
#endif

CONST Real kPi = Real(3.14159265358979323846);
CONST Real kHalfPi = Real(1.57079632679489661923);
CONST Real kTwoPi = Real(6.28318530717958647693);
CONST Real kFourPi = Real(12.5663706143591729539);
CONST Real kOneOverPi = Real(0.318309886183790671538);
CONST Real kOneOverSqrtPi = Real(0.564189583547756286948);
CONST Real kGaussPoint = Real(0.211324865405187117746);  // of two-point Gauss quadrature on [0, 1]; the other is 1 minus this
CONST Real kMaxSharpness = Real(1.0e30);
// Below this a sharpness is a constant lobe; keeps quotients of two sharpnesses clear of flushed denormals.
CONST Real kMinSharpness = Real(1.0e-30);

// Like clamp, but NaN stays NaN (GLSL's clamp may turn it into a bound).
FN Real clampReal(IN(Real) x, IN(Real) low, IN(Real) high) {
  if (isNotANumber(x)) return x;
  if (x < low) return low;
  if (x > high) return high;
  return x;
}

// sharpness in [0, kMaxSharpness]; NaN for negative or NaN.
FN Real clampSharpness(IN(Real) sharpness) {
  if (isNotANumber(sharpness) || sharpness < Real(0.0)) return notANumber();
  if (sharpness > kMaxSharpness) return kMaxSharpness;
  return sharpness;
}

// E(x) = (1 - e^-x) / x, the integral of e^(-x t) over t in [0, 1]. x >= 0; E(0) = 1, E(inf) = 0.
// Series below 1/2, where 1 - e^-x would cancel; its first dropped term is 6e-10.
FN Real oneMinusExpOver(IN(Real) x) {
  if (x < Real(0.5)) {
    return Real(1.0) + x * (-Real(1.0 / 2.0) + x * (Real(1.0 / 6.0) + x * (-Real(1.0 / 24.0) + x * (Real(1.0 / 120.0)
         + x * (-Real(1.0 / 720.0) + x * (Real(1.0 / 5040.0) + x * (-Real(1.0 / 40320.0) + x * Real(1.0 / 362880.0))))))));
  }
  return (Real(1.0) - exp(-x)) / x;
}

// 1 - e^-x for x >= 0, with full relative accuracy near 0.
FN Real oneMinusExp(IN(Real) x) {
  if (x < Real(0.5)) return x * oneMinusExpOver(x);
  return Real(1.0) - exp(-x);
}

// erf(x) / x as a function of x^2 in [0, 1]. Our fit (Chebyshev nodes, degree 7): relative error 4e-11.
FN Real erfOverArgument(IN(Real) x2) {
  return Real(1.1283791671) + x2 * (-Real(0.37612638476) + x2 * (Real(0.11283782622) + x2 * (-Real(0.026865438303)
       + x2 * (Real(0.0052210533902) + x2 * (-Real(0.00084843961933) + x2 * (Real(0.0001126825108)
       - x2 * Real(0.0000096735821507)))))));
}

// The integral of erf from 0 to x, over x^2, as a function of x^2 in [0, 1]: the series above term by term.
FN Real erfIntegralOverSquare(IN(Real) x2) {
  return Real(1.1283791671 / 2.0) + x2 * (-Real(0.37612638476 / 4.0) + x2 * (Real(0.11283782622 / 6.0)
       + x2 * (-Real(0.026865438303 / 8.0) + x2 * (Real(0.0052210533902 / 10.0) + x2 * (-Real(0.00084843961933 / 12.0)
       + x2 * (Real(0.0001126825108 / 14.0) - x2 * Real(0.0000096735821507 / 16.0)))))));
}

// Scaled complementary error function e^(x^2) erfc(x), x >= 0. Our minimax rational fit: relative error 3e-9; every
// coefficient is positive, so nothing cancels. Constant above 100: there e^(-x^2) is 0 in any precision.
FN Real erfcScaled(IN(Real) argument) {
  Real x = clampReal(argument, Real(0.0), Real(100.0));
  Real numerator = Real(1.0) + x * (Real(1.5478925) + x * (Real(1.14959837) + x * (Real(0.494672139)
                 + x * (Real(0.123455203) + x * Real(0.0148045775)))));
  Real denominator = Real(1.0) + x * (Real(2.67627155) + x * (Real(3.16944957) + x * (Real(2.14697859)
                   + x * (Real(0.889905208) + x * (Real(0.218818628) + x * Real(0.0262404305))))));
  return numerator / denominator;
}

// e^(x^2) times the integral of erfc from x to infinity, x >= 0. Same kind of fit: relative error 3e-9.
FN Real erfcIntegralScaled(IN(Real) argument) {
  Real x = clampReal(argument, Real(0.0), Real(100.0));
  Real numerator = Real(0.56418958355) + x * (Real(0.709868533) + x * (Real(0.446252372) + x * (Real(0.167747764)
                 + x * (Real(0.0377082102) + x * Real(0.00426442411)))));
  Real denominator = Real(1.0) + x * (Real(3.03066322) + x * (Real(4.16266923) + x * (Real(3.38661827)
                   + x * (Real(1.78238096) + x * (Real(0.617327355) + x * (Real(0.133672105) + x * Real(0.0151169899)))))));
  return numerator / denominator;
}

// erf(x), any x. Relative error 3e-9.
FN Real errorFunction(IN(Real) x) {
  Real magnitude = abs(x);
  if (magnitude <= Real(1.0)) return x * erfOverArgument(x * x);
  Real value = Real(1.0) - exp(-magnitude * magnitude) * erfcScaled(magnitude);
  return x < Real(0.0) ? -value : value;
}

// sin(x) for |x| <= pi/2, relative error 3e-11 (GLSL's sin promises an absolute error only).
FN Real sinQuarter(IN(Real) x) {
  Real x2 = x * x;
  return x * (Real(0.99999999998) + x2 * (-Real(0.16666666617) + x2 * (Real(0.0083333309775) + x2 * (-Real(0.00019840861548)
       + x2 * (Real(0.0000027525286855) - x2 * Real(0.000000023889493534))))));
}

// sin(pi x) and cos(pi x) for |x| <= 1; the range reduction is exact.
FN Real sinPi(IN(Real) x) {
  Real magnitude = abs(x);
  Real value = sinQuarter(kPi * (magnitude > Real(0.5) ? Real(1.0) - magnitude : magnitude));
  return x < Real(0.0) ? -value : value;
}
FN Real cosPi(IN(Real) x) { return sinQuarter(kPi * (Real(0.5) - abs(x))); }

// atan(y / x) in [0, pi/2] for y, x >= 0, not both 0 (that gives NaN). Relative error 1e-10 in exact arithmetic.
FN Real atanQuadrant(IN(Real) y, IN(Real) x) {
  if (isNotANumber(x) || isNotANumber(y)) return notANumber();
  Real larger = y > x ? y : x;
  Real smaller = y > x ? x : y;
  Real ratio = smaller / larger;
  // Above tan(pi/8) turn by pi/4: atan r = pi/4 + atan((r - 1) / (r + 1)), with r - 1 taken before the division.
  bool turned = ratio > Real(0.41421356237);
  Real t = turned ? (smaller - larger) / (smaller + larger) : ratio;
  Real t2 = t * t;
  Real angle = t * (Real(0.99999999998) + t2 * (-Real(0.33333332128) + t2 * (Real(0.199998859) + t2 * (-Real(0.14281639306)
             + t2 * (Real(0.1104105475) + t2 * (-Real(0.084591125443) + t2 * Real(0.04713004461)))))));
  if (turned) angle = Real(0.25) * kPi + angle;
  return y > x ? kHalfPi - angle : angle;
}
