// The reflection of a view direction as a mixture of SG lobes over light directions: what the runtime multiplies with light
// and visibility. (Round surfaces: reflectance.glsl.) A lobe stands for the share of the reflected light that comes from around its axis:
//   Lo += (f0 * weight + fresnelWeight) * (mean of light * visibility over the normalised lobe).
// Summed over the lobes, weight and fresnelWeight are the directional albedo split of the split-sum form, exactly, so that a uniform
// environment comes back with the right brightness whatever the lobes' shapes are off by.
#ifndef CHIARO_CPP
#include "shaders/lobe/cosine.glsl"
#include "shaders/lobe/warp.glsl"
#include "shaders/lobe/ggx.glsl"
#endif

struct SpecularLobe {
  Vec3 axis;
  Real sharpness;
  Real weight;
  Real fresnelWeight;
};

// A unit vector perpendicular to unit n, by Duff et al. 2017.
FN Vec3 anyTangent(IN(Vec3) n) {
  Real s = n.z >= Real(0.0) ? Real(1.0) : -Real(1.0);
  Real a = -Real(1.0) / (s + n.z);
  return Vec3(Real(1.0) + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x);
}

// Unit component of wo across n; any tangent when wo is along n (the lobes are then symmetric about n).
FN Vec3 incidenceTangent(IN(Vec3) n, IN(Vec3) wo) {
  Vec3 e = wo - n;  // exact where wo is nearly n; wo - n dot(n, wo) would cancel
  Vec3 across = e - n * dot(n, e);
  Real length2 = dot(across, across);
  if (length2 < Real(1.0e-8)) return anyTangent(n);
  return across * (Real(1.0) / sqrt(length2));
}

// ---- the clamped cosine's pull on a lobe ------------------------------------------------------------------------------------------

// The axis of a normalised lobe times max(dot(n, w), 0): for a von Mises-Fisher lobe the mean of the product moves by the gradient of the
// log of its integral over the sharpness (Tweedie's formula). Unit.
FN Vec3 cosineWeightedAxis(IN(Vec3) axis, IN(Real) sharpness, IN(Vec3) n) {
  Real c = dot(n, axis);
  Real stepSize = Real(0.05) / sqrt(Real(1.0) + sharpness);
  Real above = clampedCosineMean(min(c + stepSize, Real(1.0)), sharpness);
  Real below = clampedCosineMean(max(c - stepSize, -Real(1.0)), sharpness);
  Real width = min(c + stepSize, Real(1.0)) - max(c - stepSize, -Real(1.0));
  Real sum = above + below;
  if (!(sum > Real(1.0e-30)) || sharpness < Real(1.0e-3)) return c > Real(0.0) ? axis : n;
  Real logSlope = Real(2.0) * (above - below) / (width * sum);
  Vec3 moved = axis + (n - axis * c) * (logSlope / sharpness);
  return moved * (Real(1.0) / sqrt(dot(moved, moved)));
}

// ---- anisotropic: each mixture term strung along its long direction in half vectors -------------------------------------------------

// A tail term broader than this in half vectors is cut here, so that a flat distribution (alpha 1) still has lobes on the sphere.
CONST Real kBroadestHalfLobe = Real(0.6);

// Lobes to string per term for this ratio of the larger to the smaller alpha: odd, 3 to 25. About twice the ratio (ALGORITHMS 2.5) keeps a part about
// as wide as the narrow direction; fewer smear it (a brushed sphere of ratio 12 under windows: 25 dB with nine, 32 with 25).
FN int anisotropicPartCount(IN(Real) ratio) {
  int side = int(ceil(clampReal(ratio, Real(1.0), Real(12.0))));
  return 2 * side + 1;
}

// Round lobe `index` of `count` for term (a, b) of ggxMixtureTerm; alphaX along unit t, alphaY along unit b, both across n.
// The string is laid out in half vectors and each part mirrored by itself, because the light directions of a brushed surface lie on a cone
// about the brushing, not on a great circle. Envelope and round lobe convolve to the term's long deviation; each part is then warped
// isotropically (Wang et al. 2009). Weights hold D, V, the cosine and the integral; they still want the albedo's normalisation.
FN SpecularLobe anisotropicPart(IN(Vec2) term, IN(int) count, IN(int) index, IN(Vec3) n, IN(Vec3) t, IN(Vec3) b, IN(Real) alphaX, IN(Real) alphaY,
                                IN(Vec3) wo) {
  bool alongT = alphaX >= alphaY;
  Vec3 along = alongT ? t : b;
  Real varianceLong = Real(1.0) / (Real(2.0) * term.y * ggxCurvature(alongT ? alphaX : alphaY) + kBroadestHalfLobe);
  Real varianceShort = Real(1.0) / (Real(2.0) * term.y * ggxCurvature(alongT ? alphaY : alphaX) + kBroadestHalfLobe);
  // The envelope ends where it is a tenth of its peak: sqrt(2 ln 10) deviations.
  Real envelope = sqrt(max(varianceLong - varianceShort, Real(0.0)));
  Real extent = min(Real(2.1459660) * envelope, Real(1.2));
  Real spacing = Real(2.0) * extent / Real(count + 1);
  Real deviation = max(sqrt(varianceShort), Real(0.6) * spacing);
  Real share = Real(0.0);
  Real sum = Real(0.0);
  for (int i = 0; i < count; ++i) {
    Real offset = envelope > Real(0.0) ? Real(i - (count - 1) / 2) * spacing / envelope : Real(0.0);
    Real w = exp(-Real(0.5) * offset * offset);
    sum += w;
    if (i == index) share = w;
  }
  Real angle = Real(index - (count - 1) / 2) * spacing;
  Vec3 halfAxis = n * cos(angle) + along * sin(angle);

  SpecularLobe part;
  Real c = dot(wo, halfAxis);
  Vec3 axis = warpAxis(wo, halfAxis);
  part.sharpness = Real(1.0) / (deviation * deviation * Real(4.0) * clampReal(c, kMinWarpCosine, Real(1.0)));
  part.axis = cosineWeightedAxis(axis, part.sharpness, n);
  part.weight = Real(0.0);
  part.fresnelWeight = Real(0.0);
  if (c <= Real(0.0)) return part;

  Vec3 wh = wo + part.axis;
  wh = wh * (Real(1.0) / sqrt(max(dot(wh, wh), Real(1.0e-12))));
  Vec3 localOut = Vec3(dot(wo, t), dot(wo, b), dot(wo, n));
  Vec3 localIn = Vec3(dot(part.axis, t), dot(part.axis, b), max(dot(part.axis, n), Real(0.0)));
  Real amplitude = term.x * kOneOverPi / (clampAlpha(alphaX) * clampAlpha(alphaY)) * sqrt(varianceLong * varianceShort) / (deviation * deviation)
                 * share / sum;
  Real flux = amplitude * sgUnitIntegral(part.sharpness) * clampedCosineMean(dot(n, axis), part.sharpness)
            * ggxVisibilityAnisotropic(localOut, localIn, alphaX, alphaY);
  Real f = fresnelSchlickWeight(dot(wo, wh));
  part.weight = flux * (Real(1.0) - f);
  part.fresnelWeight = flux * f;
  return part;
}

// ---- light ------------------------------------------------------------------------------------------------------------------------

// alpha of a lobe seen under an SG light of this sharpness instead of a point: the half vector spreads by half the light's deviation.
FN Real alphaUnderLight(IN(Real) alpha, IN(Real) lightSharpness) {
  return min(Real(1.0), sqrt(alpha * alpha + Real(0.5) / max(lightSharpness, Real(0.5))));
}

// The shading normal bent just so far towards the viewer that dot(n, wo) >= kLeastViewCosine.
CONST Real kLeastViewCosine = Real(1.0e-3);
FN Vec3 shadingNormalTowards(IN(Vec3) n, IN(Vec3) wo) {
  Real c = dot(n, wo);
  if (c >= kLeastViewCosine) return n;
  Vec3 bent = n + wo * (kLeastViewCosine - c);
  return bent * (Real(1.0) / sqrt(dot(bent, bent)));
}
