// The clamped cosine max(dot(n, w), 0) and SG lobes.
#ifndef CHIARO_CPP
#include "shaders/lobe/sg.glsl"
#endif

// Mean of the clamped cosine over a normalised SG:  integral of max(dot(n, w), 0) G / integral of G, in [0, 1].
// cosine = dot(n, axis), taken as clamped to [-1, 1].
//
// Tokuyoshi 2024 (ALGORITHMS 1.10): between the exact ends U (axis along n) and L (against n), Lo + (U - Lo) q, where
//   q = 1/2 (c erfc(-t c) + erfc(t)) - e^(-t^2 c^2) expm1(t^2 (c^2 - 1)) / (2 sqrt(pi) t)
//     = max(c, 0) + (F(t |c|) - F(t)) / (2 t),     F(x) = integral of erfc from x to infinity,
//   t = l sqrt(1/2 (l^2 + 2.73608316 l + 17.0212978) / (l^3 + 4.01008267 l^2 + 15.2191563 l + 76.0878963)).
// The second form of q is ours: one difference of one smooth function, accurate however far the lobe is below the horizon.
// Largest error 1.3e-3 (of the whole lobe), near l = 5; 4e-8 at l = 10^4. Sharpness 0 gives 1/4.
FN Real clampedCosineMean(IN(Real) cosine, IN(Real) sharpness) {
  Real l = clampSharpness(sharpness);
  Real c = clampReal(cosine, -Real(1.0), Real(1.0));
  Real m = abs(c);
  Real t2;
  if (l < Real(1.0)) {
    t2 = Real(0.5) * l * l * ((l + Real(2.73608316)) * l + Real(17.0212978))
       / (((l + Real(4.01008267)) * l + Real(15.2191563)) * l + Real(76.0878963));
  } else {
    Real r = Real(1.0) / l;
    t2 = Real(0.5) * l * (Real(1.0) + r * (Real(2.73608316) + r * Real(17.0212978)))
       / (Real(1.0) + r * (Real(4.01008267) + r * (Real(15.2191563) + r * Real(76.0878963))));
  }
  Real t = sqrt(t2);
  Real q;
  if (t2 <= Real(1.0)) {
    q = Real(0.5) * ((Real(1.0) - m) - t * (erfIntegralOverSquare(t2) - c * c * erfIntegralOverSquare(t2 * c * c)));
  } else {
    Real gap = t2 * (Real(1.0) - m) * (Real(1.0) + m);
    Real scaledAtT = erfcIntegralScaled(t);
    Real difference;
    if (gap < Real(0.25)) {  // F(t m) - F(t) as the integral of erfc between them: two Gauss points, relative error 1e-6
      Real from = t * m;
      Real width = t * (Real(1.0) - m);
      Real x1 = width * kGaussPoint;
      Real x2 = width * (Real(1.0) - kGaussPoint);
      difference = Real(0.5) * width * (exp(-x1 * (Real(2.0) * from + x1)) * erfcScaled(from + x1)
                                      + exp(-x2 * (Real(2.0) * from + x2)) * erfcScaled(from + x2));
    } else {
      difference = (erfcIntegralScaled(t * m) - scaledAtT) + oneMinusExp(gap) * scaledAtT;
    }
    q = exp(-t2 * c * c) * difference / (Real(2.0) * t);
  }
  if (c > Real(0.0)) q = c + q;
  // U and Lo times l (so that nothing overflows), over the whole lobe's integral times l: l E(2 l) = (1 - e^(-2 l)) / 2.
  Real e = exp(-l);
  if (l < Real(0.25)) {
    Real upper = Real(0.5) + l * (-Real(1.0 / 6.0) + l * (Real(1.0 / 24.0) + l * (-Real(1.0 / 120.0) + l * (Real(1.0 / 720.0)
               + l * (-Real(1.0 / 5040.0) + l * Real(1.0 / 40320.0))))));
    Real lower = e * (Real(0.5) + l * (-Real(1.0 / 3.0) + l * (Real(3.0 / 24.0) + l * (-Real(4.0 / 120.0) + l * (Real(5.0 / 720.0)
               + l * (-Real(6.0 / 5040.0) + l * Real(7.0 / 40320.0)))))));
    return (lower + (upper - lower) * q) / (Real(2.0) * oneMinusExpOver(Real(2.0) * l));
  }
  Real meanE = oneMinusExpOver(l);
  Real upper = Real(1.0) - meanE;
  Real lower = e * (meanE - e);
  return (lower + (upper - lower) * q) / ((Real(1.0) - e) * (Real(1.0) + e));
}

// Integral of max(dot(n, w), 0) G for amplitude 1, in sr.
FN Real clampedCosineIntegral(IN(Real) cosine, IN(Real) sharpness) {
  return clampedCosineMean(cosine, sharpness) * kFourPi * oneMinusExpOver(Real(2.0) * clampSharpness(sharpness));
}

// The clamped cosine itself as `count` SG lobes on n, signed for count > 1 (ALGORITHMS 1.11, our fits).
// Relative L2 error over the sphere: .177, .112, .084, .058 for count = 1, 2, 3, 4. Only for products with a broad lobe: with a sharp one
// clampedCosineMean is far better.
CONST Real kCosineLobes[20] = {
    Real(1.17664), Real(2.14377),                                                                               // 1
    Real(2.35922), Real(3.06994), -Real(1.47066), Real(6.13989),                                                // 2
    -Real(0.60768), Real(1.18076), Real(3.06907), Real(2.36152), -Real(1.53950), Real(4.72304),                 // 3
    -Real(2.57637), Real(2.23470), Real(12.26209), Real(3.35205), -Real(13.19279), Real(5.02808), Real(4.56301), Real(7.54211)};

// Lobe `index` of `count`; count in 1..4, index in 0..count-1.
FN SphericalGaussian cosineLobe(IN(Vec3) normal, IN(int) count, IN(int) index) {
  int at = count * (count - 1) + 2 * index;
  return sphericalGaussian(normal, kCosineLobes[at + 1], kCosineLobes[at]);
}
