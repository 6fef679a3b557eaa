// The GGX reflection of a view direction as a mixture of SG lobes over light directions: what the runtime multiplies with light
// and visibility. A lobe stands for the share of the reflected light that comes from around its axis:
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

// ---- isotropic: fitted per roughness and view angle (runtime/brdf/specular_table.h) -----------------------------------------------

// The table spans these perceptual roughnesses; below, the fit is scale-free and the first row serves.
CONST Real kTableMinRoughness = Real(0.1);
CONST Real kTableMaxRoughness = Real(0.7);

// Table coordinates in [0, 1]^2 (centres of the first and last texel at 0 and 1): roughness, then sqrt(cosine), which resolves grazing angles.
FN Vec2 specularTableCoordinate(IN(Real) roughness, IN(Real) cosineOut) {
  return Vec2((clampReal(roughness, kTableMinRoughness, kTableMaxRoughness) - kTableMinRoughness) / (kTableMaxRoughness - kTableMinRoughness),
              sqrt(clampReal(cosineOut, Real(0.0), Real(1.0))));
}

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

// entry: (angle from the mirror direction towards n over alpha, log2(sharpness alpha^2), weight, fresnelWeight).
// `x` is incidenceTangent(n, wo); cosineOut = dot(n, wo) > 0.
FN SpecularLobe specularTableLobe(IN(Vec4) entry, IN(Vec3) n, IN(Vec3) x, IN(Real) cosineOut, IN(Real) alpha) {
  Real sine = sqrt(max(Real(0.0), (Real(1.0) - cosineOut) * (Real(1.0) + cosineOut)));
  Vec3 mirror = n * cosineOut - x * sine;
  Vec3 towardsN = n * sine + x * cosineOut;
  Real angle = entry.x * alpha;
  SpecularLobe lobe;
  lobe.axis = mirror * cos(angle) + towardsN * sin(angle);
  lobe.sharpness = pow(Real(2.0), entry.y) / (alpha * alpha);
  lobe.weight = entry.z;
  lobe.fresnelWeight = entry.w;
  return lobe;
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

// ---- anisotropic: an elongated Gaussian about the mirror direction, strung from round lobes -----------------------------------------

struct ElongatedLobe {
  Vec3 axis;
  Vec3 along;         // unit, across axis: the long direction
  Real deviationLong;   // radians
  Real deviationShort;
  Real amplitude;     // of D, 1/sr
};

// A tail term broader than this in half vectors is cut here, so that a flat distribution (alpha 1) still has lobes on the sphere.
CONST Real kBroadestHalfLobe = Real(0.6);

// Term (a, b) of ggxMixtureTerm for alphaX along unit tangent t and alphaY along unit bitangent b (both across n), warped to light
// directions: with h = n + step, wi moves by 2 in the plane of incidence and 2 cos across it (Wang et al. 2009; ALGORITHMS 2.3).
FN ElongatedLobe ggxWarpedTerm(IN(Vec2) term, IN(Vec3) n, IN(Vec3) t, IN(Vec3) b, IN(Real) alphaX, IN(Real) alphaY, IN(Vec3) x, IN(Vec3) wo) {
  Real c = clampReal(dot(n, wo), kMinWarpCosine, Real(1.0));
  Real qx = Real(2.0) * term.y * ggxCurvature(alphaX) + kBroadestHalfLobe;
  Real qy = Real(2.0) * term.y * ggxCurvature(alphaY) + kBroadestHalfLobe;
  // Covariance of the half vector, turned into the plane of incidence (x) and across it (y), then warped.
  Real cosX = dot(x, t);
  Real sinX = dot(x, b);
  Real sxx = (cosX * cosX / qx + sinX * sinX / qy) * Real(4.0);
  Real syy = (sinX * sinX / qx + cosX * cosX / qy) * Real(4.0) * c * c;
  Real sxy = cosX * sinX * (Real(1.0) / qy - Real(1.0) / qx) * Real(4.0) * c;
  // Eigenvectors of the symmetric 2x2 matrix.
  Real middle = Real(0.5) * (sxx + syy);
  Real difference = Real(0.5) * (sxx - syy);
  Real radius = sqrt(difference * difference + sxy * sxy);
  Real larger = middle + radius;
  Real smaller = max(middle - radius, Real(1.0e-12));
  Real ex = difference >= Real(0.0) ? radius + difference : sxy;
  Real ey = difference >= Real(0.0) ? sxy : radius - difference;
  Real scale = ex * ex + ey * ey;
  if (scale > Real(1.0e-30)) {
    ex = ex / sqrt(scale);
    ey = ey / sqrt(scale);
  } else {
    ex = Real(1.0);
    ey = Real(0.0);
  }
  // Frame across the mirror direction: in the plane of incidence, away from the viewer's side; and across it.
  Real cosineOut = dot(n, wo);
  Real sine = sqrt(max(Real(0.0), (Real(1.0) - cosineOut) * (Real(1.0) + cosineOut)));
  ElongatedLobe lobe;
  lobe.axis = n * cosineOut - x * sine;
  lobe.along = (n * sine + x * cosineOut) * ex + cross(n, x) * ey;
  lobe.deviationLong = sqrt(larger);
  lobe.deviationShort = sqrt(smaller);
  lobe.amplitude = term.x * kOneOverPi / (clampAlpha(alphaX) * clampAlpha(alphaY));
  return lobe;
}

// Round part `index` of `count` (3 or 5) of an elongated lobe: the in-plane string of ALGORITHMS 2.3, whose widths depend only on the
// ratio of the two deviations. Weights hold D, V, the cosine and the integral; they still want the albedo's normalisation.
FN SpecularLobe elongatedPart(IN(ElongatedLobe) lobe, IN(int) count, IN(int) index, IN(Vec3) n, IN(Vec3) t, IN(Vec3) b, IN(Real) alphaX,
                              IN(Real) alphaY, IN(Vec3) wo) {
  Real ratio = clampReal(lobe.deviationShort / lobe.deviationLong, kMinWarpCosine, Real(1.0));
  int k = index - (count - 1) / 2;
  int distance = k < 0 ? -k : k;
  Real width = warpTable(ratio, count, 0) * lobe.deviationLong;
  Real angle = clampReal(Real(k) * warpTable(ratio, count, 1) * lobe.deviationLong, -Real(1.2), Real(1.2));
  SpecularLobe part;
  Vec3 axis = lobe.axis * cos(angle) + lobe.along * sin(angle);
  part.sharpness = Real(1.0) / (width * width);
  part.axis = cosineWeightedAxis(axis, part.sharpness, n);
  Vec3 wh = wo + part.axis;
  wh = wh * (Real(1.0) / sqrt(max(dot(wh, wh), Real(1.0e-12))));
  Vec3 localOut = Vec3(dot(wo, t), dot(wo, b), dot(wo, n));
  Vec3 localIn = Vec3(dot(part.axis, t), dot(part.axis, b), max(dot(part.axis, n), Real(0.0)));
  Real amplitude = lobe.amplitude * warpTable(ratio, count, 2 + distance);
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
