// Spherical Gaussians:  G(w) = amplitude * exp(sharpness * (dot(axis, w) - 1)),  sharpness >= 0, axis and w unit.
// A sharpness of 0 is the constant `amplitude`. Wang et al. 2009; Tsai and Shih 2006; numbered formulas: ALGORITHMS 1.x.
//
// Every form below works with |a - b|^2 instead of dot(a, b) - 1, which in float loses everything at high sharpness,
// and never forms exp of a large positive number. Unit axes may be off by float rounding (1e-6 in length).
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

struct SphericalGaussian {
  Vec3 axis;
  Real sharpness;
  Real amplitude;
};

FN SphericalGaussian sphericalGaussian(IN(Vec3) axis, IN(Real) sharpness, IN(Real) amplitude) {
  SphericalGaussian g;
  g.axis = axis;
  g.sharpness = sharpness;
  g.amplitude = amplitude;
  return g;
}

// G(direction).
FN Real sgEvaluate(IN(SphericalGaussian) g, IN(Vec3) direction) {
  Vec3 difference = direction - g.axis;
  return g.amplitude * exp(-Real(0.5) * clampSharpness(g.sharpness) * dot(difference, difference));
}

// Integral of exp(sharpness (cos - 1)) over the sphere, in sr: 4 pi E(2 sharpness).
FN Real sgUnitIntegral(IN(Real) sharpness) { return kFourPi * oneMinusExpOver(Real(2.0) * clampSharpness(sharpness)); }

// Integral of G over the sphere.
FN Real sgIntegral(IN(SphericalGaussian) g) { return g.amplitude * sgUnitIntegral(g.sharpness); }

// L2 norm: sqrt of the integral of G^2.
FN Real sgNorm(IN(SphericalGaussian) g) {
  return abs(g.amplitude) * sqrt(kFourPi * oneMinusExpOver(Real(4.0) * clampSharpness(g.sharpness)));
}

// The product of two lobes of amplitude 1: its axis and sharpness d, and the log of its amplitude (always <= 0).
// With l1 >= l2:  v = l1 a1 + l2 a2 = (l1 - l2) a1 + l2 (a1 + a2). The two terms never point against each other, so |v| keeps
// its relative accuracy for opposite axes; everything is divided by l1, so nothing overflows.
FN SphericalGaussian sgProductLog(IN(Vec3) axis1, IN(Real) sharpness1, IN(Vec3) axis2, IN(Real) sharpness2) {
  Real total = clampSharpness(sharpness1) + clampSharpness(sharpness2);
  if (isNotANumber(total)) return sphericalGaussian(axis1, total, total);
  bool swapped = sharpness2 > sharpness1;
  Vec3 a1 = swapped ? axis2 : axis1;
  Vec3 a2 = swapped ? axis1 : axis2;
  Real l1 = clampSharpness(swapped ? sharpness2 : sharpness1);
  Real l2 = clampSharpness(swapped ? sharpness1 : sharpness2);
  if (l1 < kMinSharpness) return sphericalGaussian(axis1, total, Real(0.0));  // two constants
  Real ratio = l2 / l1;
  Vec3 v = ((l1 - l2) / l1) * a1 + ratio * (a1 + a2);
  Vec3 difference = a1 - a2;
  Real d = sqrt(dot(v, v));
  Real logAmplitude = -l2 * dot(difference, difference) / (d + Real(1.0) + ratio);
  // Opposite axes of equal sharpness cancel to a constant, whose axis means nothing: keep the first.
  Vec3 axis = d == Real(0.0) ? axis1 : v / d;
  return sphericalGaussian(axis, l1 * d, logAmplitude);
}

// G1 G2, again an SG (exactly).
FN SphericalGaussian sgProduct(IN(SphericalGaussian) g1, IN(SphericalGaussian) g2) {
  SphericalGaussian p = sgProductLog(g1.axis, g1.sharpness, g2.axis, g2.sharpness);
  return sphericalGaussian(p.axis, p.sharpness, g1.amplitude * g2.amplitude * exp(p.amplitude));
}

// Integral of G1 G2 over the sphere.
FN Real sgInnerProduct(IN(SphericalGaussian) g1, IN(SphericalGaussian) g2) {
  SphericalGaussian p = sgProductLog(g1.axis, g1.sharpness, g2.axis, g2.sharpness);
  return kFourPi * g1.amplitude * g2.amplitude * exp(p.amplitude) * oneMinusExpOver(Real(2.0) * p.sharpness);
}

// <G1, G2> / (|G1| |G2|) in (0, 1]: how alike two lobes are, whatever their amplitudes (Tokuyoshi 2015, eq. 4, without its
// overflow).
FN Real sgNormalizedInnerProduct(IN(SphericalGaussian) g1, IN(SphericalGaussian) g2) {
  SphericalGaussian p = sgProductLog(g1.axis, g1.sharpness, g2.axis, g2.sharpness);
  return exp(p.amplitude) * oneMinusExpOver(Real(2.0) * p.sharpness)
       / (sqrt(oneMinusExpOver(Real(4.0) * clampSharpness(g1.sharpness)))
        * sqrt(oneMinusExpOver(Real(4.0) * clampSharpness(g2.sharpness))));
}

// ---- von Mises-Fisher: an SG that integrates to 1 ------------------------------------------------------------------

// Amplitude of the SG that integrates to 1: 1 / (4 pi E(2 sharpness)), in 1/sr.
FN Real vmfAmplitude(IN(Real) sharpness) {
  Real l = clampSharpness(sharpness);
  if (l < Real(1.0)) return Real(1.0) / (kFourPi * oneMinusExpOver(Real(2.0) * l));
  return l / (kTwoPi * (Real(1.0) - exp(-Real(2.0) * l)));  // no reciprocal of a denormal
}

// Mean cosine to the axis, A(l) = coth(l) - 1/l, in [0, 1). Series below 0.7.
FN Real vmfMeanCosine(IN(Real) sharpness) {
  Real l = clampSharpness(sharpness);
  if (l < Real(0.7)) {
    Real x = l * l;
    return l * (Real(1.0 / 3.0) + x * (-Real(1.0 / 45.0) + x * (Real(2.0 / 945.0) + x * (-Real(1.0 / 4725.0)
         + x * (Real(2.0 / 93555.0) + x * (-Real(1382.0 / 638512875.0) + x * Real(4.0 / 18243225.0)))))));
  }
  Real e = exp(-Real(2.0) * l);
  return (Real(1.0) + e) / (Real(1.0) - e) - Real(1.0) / l;
}

// 1 - A(l), which stays accurate where A rounds to 1; tends to 1/l.
FN Real oneMinusMeanCosine(IN(Real) sharpness) {
  Real l = clampSharpness(sharpness);
  if (l < Real(0.7)) return Real(1.0) - vmfMeanCosine(l);
  Real e = exp(-Real(2.0) * l);
  return Real(1.0) / l - Real(2.0) * e / (Real(1.0) - e);
}

// A'(l) = 1/l^2 - 1/sinh(l)^2 > 0.
FN Real vmfMeanCosineSlope(IN(Real) l) {
  if (l < Real(0.7)) {
    Real x = l * l;
    return Real(1.0 / 3.0) + x * (-Real(3.0 / 45.0) + x * (Real(10.0 / 945.0) + x * (-Real(7.0 / 4725.0) + x * Real(18.0 / 93555.0))));
  }
  Real e = exp(-Real(2.0) * l);
  Real oneMinusE = Real(1.0) - e;
  return Real(1.0) / (l * l) - Real(4.0) * e / (oneMinusE * oneMinusE);
}

// The sharpness whose mean cosine is r in [0, 1), with deficit = 1 - r passed apart because it may be known better; Banerjee's start and three
// Newton steps (formula error 1e-9). 1 gives +inf; outside [0, 1] gives NaN. Above 1/2 the steps solve for 1 - A, which is where the accuracy is.
FN Real vmfSharpness(IN(Real) r, IN(Real) deficit) {
  if (r < Real(0.0) || r > Real(1.0)) return notANumber();
  if (deficit == Real(0.0)) return positiveInfinity();
  Real l = r * (Real(3.0) - r * r) / (deficit * (Real(1.0) + r));
  for (int i = 0; i < 3; ++i) {
    Real excess = r < Real(0.5) ? vmfMeanCosine(l) - r : deficit - oneMinusMeanCosine(l);
    l -= excess / vmfMeanCosineSlope(l);
  }
  return l;
}

FN Real vmfSharpnessFromMeanCosine(IN(Real) meanCosine) { return vmfSharpness(meanCosine, Real(1.0) - meanCosine); }

// Convolution of `g` with the zonal kernel `kernel` (its axis is not read), as an SG about g.axis whose integral is the
// product of both integrals, exactly. Sharpness: first-moment rule (mean cosines multiply) when the broader lobe is below 3,
// else harmonic l1 l2 / (l1 + l2) (Iwasaki et al. 2012). Relative L2 error of the shape at most .006 below 1, .04 at worst near 3 to 5,
// falling as 1/l beyond.
FN SphericalGaussian sgConvolve(IN(SphericalGaussian) g, IN(SphericalGaussian) kernel) {
  Real l1 = clampSharpness(g.sharpness);
  Real l2 = clampSharpness(kernel.sharpness);
  if (isNotANumber(l1) || isNotANumber(l2)) return sphericalGaussian(g.axis, notANumber(), notANumber());
  Real broad = l1 < l2 ? l1 : l2;
  Real sharp = l1 < l2 ? l2 : l1;
  Real l3;
  if (broad < Real(3.0)) {
    l3 = vmfSharpnessFromMeanCosine(vmfMeanCosine(l1) * vmfMeanCosine(l2));
  } else {
    l3 = broad / (Real(1.0) + broad / sharp);
  }
  // E(2 l1) / E(2 l3) first: the product of two integrals of sharp lobes could underflow.
  Real gain = oneMinusExpOver(Real(2.0) * sharp) / oneMinusExpOver(Real(2.0) * l3);
  Real amplitude = g.amplitude * kernel.amplitude * kFourPi * gain * oneMinusExpOver(Real(2.0) * broad);
  return sphericalGaussian(g.axis, l3, amplitude);
}
