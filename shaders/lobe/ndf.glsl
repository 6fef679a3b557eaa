// Reflectance models, each split into a distribution of half vectors that is 1 at its peak and a smooth factor (ALGORITHMS 2.1; Wang et al.
// 2009, section 4):
//   rho(wi, wo) = F(wo.wh) * smooth(wi, wo) * ndf(wh)
// Vectors are unit, in the tangent frame (x tangent, y bitangent, z normal). Normalised so that the albedo stays at or below 1, but for Ward
// and Cook-Torrance's groove masking at grazing views, whose published forms gain there.
// A value is 0 where wo, wi or wh is not above the surface. NaN in gives NaN out.
#ifndef CHIARO_CPP
#include "shaders/lobe/ggx.glsl"
#endif

CONST int kCookTorrance = 0;       // Gaussian of the half vector's angle, width m; groove masking
CONST int kBeckmann = 1;           // width m; Smith masking of its own distribution
CONST int kBlinnPhong = 2;         // exponent n
CONST int kWard = 3;               // width alpha
CONST int kGgx = 4;                // width alpha; height-correlated Smith masking
CONST int kAshikhminShirley = 5;   // exponents n_u, n_v
CONST int kModelCount = 6;

CONST Real kMinExponent = Real(1.0);
CONST Real kMaxExponent = Real(1.0e6);

// x, y: widths (in [kMinAlpha, 1]) or exponents (in [kMinExponent, kMaxExponent]) along tangent and bitangent, taken as clamped there.
// Cook-Torrance and Blinn-Phong are round: they read x alone.
struct ReflectanceModel {
  int kind;
  Real x;
  Real y;
};

FN bool modelHasExponent(IN(int) kind) { return kind == kBlinnPhong || kind == kAshikhminShirley; }

FN ReflectanceModel reflectanceModel(IN(int) kind, IN(Real) x, IN(Real) y) {
  ReflectanceModel m;
  m.kind = kind;
  m.x = modelHasExponent(kind) ? clampReal(x, kMinExponent, kMaxExponent) : clampAlpha(x);
  m.y = modelHasExponent(kind) ? clampReal(y, kMinExponent, kMaxExponent) : clampAlpha(y);
  if (kind == kCookTorrance || kind == kBlinnPhong) m.y = m.x;
  return m;
}

// log(1 + x), x >= 0, relative error 1e-8: below 1 by 2 atanh(x / (2 + x)), since GLSL's log is only good to an absolute error near 1.
FN Real logOnePlus(IN(Real) x) {
  if (x >= Real(1.0)) return log(Real(1.0) + x);
  Real z = x / (Real(2.0) + x);
  Real z2 = z * z;
  return Real(2.0) * z * (Real(1.0) + z2 * (Real(1.0 / 3.0) + z2 * (Real(1.0 / 5.0) + z2 * (Real(1.0 / 7.0) + z2 * (Real(1.0 / 9.0)
       + z2 * (Real(1.0 / 11.0) + z2 * (Real(1.0 / 13.0) + z2 * Real(1.0 / 15.0))))))));
}

// e^-x, exactly 0 beyond 80, where it is below 2e-35: so that a vanishing tail never meets an overflowing factor.
FN Real vanishingExp(IN(Real) x) { return x > Real(80.0) ? Real(0.0) : exp(-x); }

// The distribution of half vectors, 1 at wh = +z. Beckmann's 1/cos^4 belongs to it, so wide ones (m > .7) peak off the normal, at most 1.48.
FN Real ndfValue(IN(ReflectanceModel) m, IN(Vec3) wh) {
  if (isNotANumber(wh.x + wh.y + wh.z + m.x + m.y)) return notANumber();
  if (!(wh.z > Real(0.0))) return Real(0.0);
  if (m.kind == kGgx) {
    Real gx = wh.x / m.x;
    Real gy = wh.y / m.y;
    Real s = gx * gx + gy * gy + wh.z * wh.z;
    return Real(1.0) / (s * s);
  }
  Real across2 = wh.x * wh.x + wh.y * wh.y;
  if (m.kind == kCookTorrance) {
    Real ratio = atanQuadrant(sqrt(across2), wh.z) / m.x;
    return vanishingExp(ratio * ratio);
  }
  // Beyond this slope every distribution but GGX is 0 or, for small exponents, as good as 0.
  Real z = max(wh.z, Real(1.0e-9));
  if (m.kind == kBlinnPhong) return vanishingExp(Real(0.5) * m.x * logOnePlus(across2 / (z * z)));
  if (m.kind == kAshikhminShirley) {
    if (across2 < Real(1.0e-30)) return Real(1.0);
    Real exponent = (m.x * wh.x * wh.x + m.y * wh.y * wh.y) / across2;
    return vanishingExp(Real(0.5) * exponent * logOnePlus(across2 / (z * z)));
  }
  Real tx = wh.x / (z * m.x);
  Real ty = wh.y / (z * m.y);
  Real value = vanishingExp(tx * tx + ty * ty);
  if (m.kind == kBeckmann) {
    Real z2 = max(wh.z * wh.z, Real(1.0e-4));  // the exponential is 0 long before
    value = value / (z2 * z2);
  }
  return value;
}

// Beckmann's Smith Lambda times cos(w), for w above the surface: Lambda = e^(-a^2) / (2 a sqrt pi) - erfc(a) / 2, a = cos / (m sin).
// Times the cosine it is finite at the horizon, (m sin) / (2 sqrt pi).
FN Real beckmannLambdaTimesCosine(IN(Vec3) w, IN(Real) mx, IN(Real) my) {
  Real slope = sqrt(mx * mx * w.x * w.x + my * my * w.y * w.y);
  Real cosine = max(w.z, Real(0.0));
  if (slope * Real(9.0) <= cosine) return Real(0.0);  // e^-81
  Real a = cosine / slope;
  return Real(0.5) * exp(-a * a) * max(slope * kOneOverSqrtPi - cosine * erfcScaled(a), Real(0.0));
}

// The smooth factor times dot(n, wi), 1/sr, without Fresnel. Finite at grazing angles: cosines of wo count as at least kMinCosine.
FN Real smoothTimesCosine(IN(ReflectanceModel) m, IN(Vec3) wo, IN(Vec3) wi) {
  if (isNotANumber(wo.x + wo.y + wo.z + wi.x + wi.y + wi.z + m.x + m.y)) return notANumber();
  if (!(wo.z > Real(0.0)) || !(wi.z > Real(0.0))) return Real(0.0);
  Real o = max(wo.z, kMinCosine);
  Real i = min(wi.z, Real(1.0));
  Vec3 sum = wo + wi;
  Real twiceHalf = max(sqrt(dot(sum, sum)), Real(2.0) * kMinCosine);  // |wo + wi| = 2 dot(wo, wh)
  if (m.kind == kBlinnPhong) {
    return i * (m.x + Real(2.0)) * (m.x + Real(4.0)) / (Real(2.0) * kFourPi * (exp(-Real(0.34657359028) * m.x) + m.x));
  }
  if (m.kind == kAshikhminShirley) {
    return i * sqrt((m.x + Real(1.0)) * (m.y + Real(1.0))) / (kFourPi * twiceHalf * max(i, o));
  }
  Real area = Real(1.0) / (kPi * m.x * m.y);
  if (m.kind == kWard) return Real(0.25) * area * sqrt(i / o);
  if (m.kind == kGgx) return area * ggxVisibilityAnisotropic(wo, wi, m.x, m.y) * i;
  if (m.kind == kCookTorrance) {
    // The groove's 2 (n.wh) / (wo.wh) is 4 (wo.z + wi.z) / |wo + wi|^2.
    Real groove = Real(4.0) * (wo.z + wi.z) / (twiceHalf * twiceHalf);
    return Real(0.25) * area * min(Real(1.0) / o, min(groove, groove * i / o));
  }
  // Beckmann: G / (4 o i) * i = 1 / (4 o (1 + L(o) + L(i)))
  Real lambdaOut = beckmannLambdaTimesCosine(wo, m.x, m.y);
  Real lambdaIn = beckmannLambdaTimesCosine(wi, m.x, m.y);
  return Real(0.25) * area * i / (i * (o + lambdaOut) + o * lambdaIn);
}

// wh of two directions; the normal where they are opposite.
FN Vec3 halfVector(IN(Vec3) wo, IN(Vec3) wi) {
  Vec3 sum = wo + wi;
  Real length2 = dot(sum, sum);
  if (length2 < Real(1.0e-12)) return Vec3(Real(0.0), Real(0.0), Real(1.0));
  return sum / sqrt(length2);
}

// rho * dot(n, wi) with Fresnel 1, 1/sr.
FN Real modelTimesCosine(IN(ReflectanceModel) m, IN(Vec3) wo, IN(Vec3) wi) {
  Real smoothPart = smoothTimesCosine(m, wo, wi);
  if (smoothPart == Real(0.0)) return Real(0.0);
  return smoothPart * ndfValue(m, halfVector(wo, wi));
}

// The same with Schlick's Fresnel from f0, by channel.
FN Vec3 reflectanceTimesCosine(IN(ReflectanceModel) m, IN(Vec3) f0, IN(Vec3) wo, IN(Vec3) wi) {
  return fresnelSchlick(f0, dot(wo, halfVector(wo, wi))) * modelTimesCosine(m, wo, wi);
}

// ---- spherical Gaussians for the distributions (ALGORITHMS 2.2) --------------------------------------------------------------------

// (amplitude, sharpness) of the paper's lobe: Taylor's second term, peak 1. `width` along one direction, a width or an exponent.
FN Vec2 ndfPaperLobe(IN(int) kind, IN(Real) width) {
  if (modelHasExponent(kind)) return Vec2(Real(1.0), width);
  return Vec2(Real(1.0), Real(2.0) / (width * width));
}

// The one lobe of least L2 error over the hemisphere. Relative error .042 m^2 (Cook-Torrance), .25/n (Blinn-Phong), .37 alpha^2 (Ward),
// .39 m^2 (Beckmann) up to m = .3; GGX .14 to .2.
FN Vec2 ndfBestLobe(IN(int) kind, IN(Real) width) {
  if (kind == kGgx) return ggxMixtureLobe(width, 1, 0);
  if (modelHasExponent(kind)) return Vec2(Real(1.0) + Real(0.25) / width, width + Real(1.0));
  Real w2 = width * width;
  if (kind == kCookTorrance) return Vec2(Real(1.0) + w2 * Real(1.0 / 24.0), Real(2.0) / w2 + Real(1.0 / 3.0));
  if (kind == kWard) return Vec2(Real(1.0) + Real(0.37) * w2, Real(2.0) / w2 + Real(3.0));
  return Vec2(Real(1.0) + Real(0.39) * w2, Real(2.0) / w2 - Real(1.0));
}

// Lobe `index` of `count` (1..4) for a round distribution. Only GGX has a use for more than one; the others give one lobe and amplitude 0.
FN Vec2 ndfMixtureLobe(IN(int) kind, IN(Real) width, IN(int) count, IN(int) index) {
  if (kind == kGgx) return ggxMixtureLobe(width, count, index);
  Vec2 lobe = ndfBestLobe(kind, width);
  return index == 0 ? lobe : Vec2(Real(0.0), lobe.y);
}

// ---- where the renderer leaves lobes ------------------------------------------------------------------------------------------------

// Share of the reflection that is the reflectance itself at fixed broad lobes, the rest its own SG lobes: passes over between two perceptual roughnesses
// sqrt(alpha). Models with fitted lobes keep these further than GGX.
FN Real roughReflectionShare(IN(int) kind, IN(Real) alpha) {
  Real from = kind == kGgx ? Real(0.45) : Real(0.5);
  Real t = clampReal((sqrt(max(alpha, Real(0.0))) - from) / Real(0.15), Real(0.0), Real(1.0));
  return t * t * (Real(3.0) - Real(2.0) * t);
}

// ---- elongated lobes: round ones along the long direction (Wang et al. 2009, supplement, eq. 14; ALGORITHMS 2.5) ----------------------

// A round lobe of a string: angle from the middle along the long direction, sharpness, amplitude.
struct StringLobe {
  Real angle;
  Real sharpness;
  Real amplitude;
};

// Lobes that a ratio of sharpnesses needs: odd ceil(2 sqrt(ratio)).
FN int stringLobeCount(IN(Real) sharp, IN(Real) broad) {
  int count = int(ceil(Real(2.0) * sqrt(clampReal(sharp / broad, Real(1.0), Real(1.0e4)))));
  return count - 2 * (count / 2) == 1 ? count : count + 1;
}

// cos^n of an angle whose cosine is positive, as a power of its tangent.
FN Real cosinePower(IN(Real) angle, IN(Real) n) {
  Real s = sinQuarter(angle);
  Real c = sinQuarter(kHalfPi - abs(angle));
  if (!(c > Real(1.0e-6))) return Real(0.0);
  return vanishingExp(Real(0.5) * n * logOnePlus(s * s / (c * c)));
}

// The spacing of `count` lobes over an envelope cos^n that falls to `least` at its end: 2 arccos(least^(1/n)) / (count + 1).
FN Real stringSpacing(IN(Real) n, IN(Real) least, IN(int) count) {
  Real drop = min(-Real(2.0) * log(least) / max(n, Real(1.0e-3)), Real(80.0));  // of log cos^2
  return Real(2.0) * atanQuadrant(sqrt(exp(drop) * oneMinusExp(drop)), Real(1.0)) / Real(count + 1);
}

// The paper's own rule for a lobe of sharpnesses `sharp` >= `broad` > 0 in its two directions: envelope and amplitudes from the broad one.
// The lobes overlap and add up: their energy is 1.2 to 1.7 times the lobe's.
FN StringLobe paperStringLobe(IN(Real) sharp, IN(Real) broad, IN(int) count, IN(int) index) {
  StringLobe lobe;
  lobe.angle = Real(index - (count - 1) / 2) * stringSpacing(broad, Real(0.1), count);
  lobe.sharpness = sharp;
  lobe.amplitude = cosinePower(lobe.angle, broad);
  return lobe;
}

// Ours: the envelope is the one that a lobe spreads to the right width, n' = sharp broad / (sharp - broad), and the sum is 1 at the peak.
// Squared error 3e-4 to 3e-3 with stringLobeCount lobes, energy .95 to 1.
FN StringLobe ndfStringLobe(IN(Real) sharp, IN(Real) broad, IN(int) count, IN(int) index) {
  Real n = broad / max((sharp - broad) / sharp, Real(1.0e-6));
  // The envelope's end: .03 of its peak suits ratios up to 20, .1 from 50 on.
  Real far = clampReal((sharp / max(broad, Real(1.0e-6)) - Real(20.0)) / Real(30.0), Real(0.0), Real(1.0));
  Real spacing = stringSpacing(n, Real(0.03) + Real(0.07) * far, count);
  int middle = (count - 1) / 2;
  Real sum = Real(1.0);
  for (int k = 1; k <= middle; ++k) {
    Real sine = sinQuarter(Real(0.5) * Real(k) * spacing);
    sum += Real(2.0) * cosinePower(Real(k) * spacing, n) * vanishingExp(Real(2.0) * sharp * sine * sine);
  }
  StringLobe lobe;
  lobe.angle = Real(index - middle) * spacing;
  lobe.sharpness = sharp;
  lobe.amplitude = cosinePower(lobe.angle, n) / sum;
  return lobe;
}
