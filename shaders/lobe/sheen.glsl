// Fuzz: the sheen of KHR_materials_sheen (Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, 2017).
// alpha = perceptual roughness^2 in [kMinSheenAlpha, 1], taken as clamped there. Cosines are of unit vectors with the shading normal.
#ifndef CHIARO_CPP
#include "shaders/lobe/ndf.glsl"
#endif

CONST Real kMinSheenAlpha = Real(0.0049);  // perceptual roughness .07: smoother fuzz would be a rim below a pixel

FN Real clampSheenAlpha(IN(Real) alpha) { return clampReal(alpha, kMinSheenAlpha, Real(1.0)); }

// Distribution of half vectors, (2 + 1/alpha) sin^(1/alpha) / (2 pi): 0 at the normal; its integral times the cosine over the hemisphere is 1.
FN Real sheenDistribution(IN(Real) cosine, IN(Real) alpha) {
  Real inverse = Real(1.0) / clampSheenAlpha(alpha);
  Real c = clampReal(cosine, Real(0.0), Real(1.0));
  Real sine2 = max((Real(1.0) - c) * (Real(1.0) + c), Real(1.0e-30));
  return (Real(2.0) + inverse) * vanishingExp(-Real(0.5) * inverse * log(sine2)) * (Real(0.5) * kOneOverPi);
}

// Their fitted shadowing, equation 3 with the terminator softening left out: Lambda(cosine).
FN Real sheenLambdaLog(IN(Real) x, IN(Real) t) {
  Real a = Real(21.5473) + t * Real(3.7772);
  Real b = Real(3.82987) - t * Real(0.50552);
  Real c = Real(0.19823) - t * Real(0.03022);
  Real d = -Real(1.97760) + t * Real(0.70367);
  Real e = -Real(4.32054) - t * Real(0.53913);
  return a / (Real(1.0) + b * pow(x, c)) + d * x + e;
}
FN Real sheenLambda(IN(Real) cosine, IN(Real) alpha) {
  Real x = clampReal(cosine, kMinCosine, Real(1.0));
  Real smoothness = Real(1.0) - clampSheenAlpha(alpha);
  Real t = smoothness * smoothness;
  if (x < Real(0.5)) return exp(sheenLambdaLog(x, t));
  return exp(Real(2.0) * sheenLambdaLog(Real(0.5), t) - sheenLambdaLog(max(Real(1.0) - x, Real(1.0e-6)), t));
}

// D / (4 (1 + Lambda(wo) + Lambda(wi)) (n.wo) (n.wi)), 1/sr, of a sheen of colour 1; 0 below the horizon.
FN Real sheenReflectance(IN(Real) cosineOut, IN(Real) cosineIn, IN(Real) cosineHalf, IN(Real) alpha) {
  if (isNotANumber(cosineOut + cosineIn + cosineHalf + alpha)) return notANumber();
  if (!(cosineOut > Real(0.0)) || !(cosineIn > Real(0.0))) return Real(0.0);
  Real o = max(cosineOut, kMinCosine);
  Real i = max(cosineIn, kMinCosine);
  return sheenDistribution(cosineHalf, alpha) / ((Real(1.0) + sheenLambda(o, alpha) + sheenLambda(i, alpha)) * (Real(4.0) * o * i));
}
