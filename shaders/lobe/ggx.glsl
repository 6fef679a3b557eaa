// GGX (Trowbridge-Reitz) microfacets and the SG mixtures that stand in for their distribution.
// alpha = perceptualRoughness^2 in [kMinAlpha, 1], taken as clamped there. Cosines are of unit vectors with the shading normal.
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

CONST Real kMinAlpha = Real(1.0e-4);
// Grazing cosines below this are taken as this (ALGORITHMS 2.1), so that 1/cosine stays finite.
CONST Real kMinCosine = Real(1.0e-4);

FN Real clampAlpha(IN(Real) alpha) { return clampReal(alpha, kMinAlpha, Real(1.0)); }

// D(h), isotropic, 1/sr; integral of D cos over the hemisphere is 1. cosine = dot(n, h) in [0, 1]. The denominator is a sum of positive
// terms: c^2 alpha^2 + (1 - c)(1 + c); the usual c^2 (alpha^2 - 1) + 1 loses the peak of smooth surfaces.
FN Real ggxDistribution(IN(Real) cosine, IN(Real) alpha) {
  Real a = clampAlpha(alpha);
  Real c = clampReal(cosine, Real(0.0), Real(1.0));
  Real width = c * a;
  Real s = width * width + (Real(1.0) - c) * (Real(1.0) + c);
  Real root = a / s;
  return root * root * kOneOverPi;
}

// D(h), anisotropic; `wh` unit in the tangent frame (z along n, z >= 0). 1 / (pi ax ay ((hx/ax)^2 + (hy/ay)^2 + hz^2)^2).
FN Real ggxDistributionAnisotropic(IN(Vec3) wh, IN(Real) alphaX, IN(Real) alphaY) {
  Real ax = clampAlpha(alphaX);
  Real ay = clampAlpha(alphaY);
  Real x = wh.x / ax;
  Real y = wh.y / ay;
  Real s = x * x + y * y + wh.z * wh.z;
  return Real(1.0) / (kPi * ax * ay * s * s);
}

// Height-correlated Smith visibility V = G / (4 (n.wo)(n.wi)), so that the BRDF is F D V. Symmetric.
FN Real ggxVisibility(IN(Real) cosineOut, IN(Real) cosineIn, IN(Real) alpha) {
  Real a2 = clampAlpha(alpha) * clampAlpha(alpha);
  Real o = clampReal(cosineOut, kMinCosine, Real(1.0));
  Real i = clampReal(cosineIn, kMinCosine, Real(1.0));
  return Real(0.5) / (i * sqrt(a2 + (Real(1.0) - a2) * o * o) + o * sqrt(a2 + (Real(1.0) - a2) * i * i));
}

// The same for alphaX, alphaY; wo and wi unit in the tangent frame.
FN Real ggxVisibilityAnisotropic(IN(Vec3) wo, IN(Vec3) wi, IN(Real) alphaX, IN(Real) alphaY) {
  Real ax = clampAlpha(alphaX);
  Real ay = clampAlpha(alphaY);
  Real o = clampReal(wo.z, kMinCosine, Real(1.0));
  Real i = clampReal(wi.z, kMinCosine, Real(1.0));
  Real slopeOut = sqrt(ax * ax * wo.x * wo.x + ay * ay * wo.y * wo.y + o * o);
  Real slopeIn = sqrt(ax * ax * wi.x * wi.x + ay * ay * wi.y * wi.y + i * i);
  return Real(0.5) / (i * slopeOut + o * slopeIn);
}

// Schlick's Fresnel, F0 + (1 - F0)(1 - cosine)^5; cosine = dot(wo, wh), taken as clamped to [0, 1].
FN Real fresnelSchlickWeight(IN(Real) cosine) {
  Real x = Real(1.0) - clampReal(cosine, Real(0.0), Real(1.0));
  Real x2 = x * x;
  return x2 * x2 * x;
}
FN Vec3 fresnelSchlick(IN(Vec3) f0, IN(Real) cosine) {
  Real w = fresnelSchlickWeight(cosine);
  return f0 + (Vec3(Real(1.0), Real(1.0), Real(1.0)) - f0) * w;
}

// Directional albedo for F = 1, split into (what F0 scales, what Fresnel adds), for a viewer wo in the tangent frame: quadrature over the half vectors that
// the viewer sees (Heitz 2018; Dupuy and Benyoub 2023), each of which reflects G / G1. Within .027 for alphas .01 to 1, of which .02 is what the
// horizon cuts off. A round surface has it from a table.
CONST Real kAlbedoNodes[8] = {  // Gauss and Legendre's, node and weight, in the root of 1 - u: dense where half vectors lean
    Real(0.0694318442), Real(0.1739274226), Real(0.3300094782), Real(0.3260725774),
    Real(0.6699905218), Real(0.3260725774), Real(0.9305681558), Real(0.1739274226)};
FN Vec2 ggxAlbedoAnisotropic(IN(Vec3) wo, IN(Real) alphaX, IN(Real) alphaY) {
  Real ax = clampAlpha(alphaX);
  Real ay = clampAlpha(alphaY);
  Real o = clampReal(wo.z, kMinCosine, Real(1.0));
  Vec3 stretched = Vec3(ax * wo.x, ay * wo.y, o);
  Real slopeOut = sqrt(dot(stretched, stretched));
  stretched = stretched * (Real(1.0) / slopeOut);
  Vec2 sum = Vec2(Real(0.0), Real(0.0));
  for (int i = 0; i < 4; ++i) {
    Real root = kAlbedoNodes[2 * i];
    Real lean = root * root * (Real(1.0) + stretched.z);  // z of the half vector, before it is unit
    Real z = lean - stretched.z;
    Real s = sqrt(max(Real(1.0) - z * z, Real(0.0)));
    for (int j = 0; j < 8; ++j) {
      Real turn = Real(0.25) * kPi * (Real(j) + Real(0.25) + Real(0.5) * Real(i - 2 * (i / 2)));
      Vec3 wh = Vec3(ax * (s * cos(turn) + stretched.x), ay * (s * sin(turn) + stretched.y), lean);
      wh = wh * (Real(1.0) / sqrt(max(dot(wh, wh), Real(1.0e-30))));
      Real c = dot(wo, wh);
      Vec3 wi = Real(2.0) * c * wh - wo;
      if (!(wi.z > Real(0.0))) continue;
      Real slopeIn = sqrt(ax * ax * wi.x * wi.x + ay * ay * wi.y * wi.y + wi.z * wi.z);
      Real reflected = wi.z * (o + slopeOut) / (slopeOut * wi.z + slopeIn * o) * kAlbedoNodes[2 * i + 1] * root * Real(0.25);
      Real f = fresnelSchlickWeight(c);
      sum = sum + Vec2(reflected * (Real(1.0) - f), reflected * f);
    }
  }
  return sum;
}

// k = 1/alpha^2 - 1, the curvature of the peak-1 distribution (1 + y)^-2, y = kx hx^2 + ky hy^2 (over hz^2 hx.. in slope form).
FN Real ggxCurvature(IN(Real) alpha) {
  Real a = clampAlpha(alpha);
  return (Real(1.0) - a) * (Real(1.0) + a) / (a * a);
}

// Mixture (A), ALGORITHMS 2.2: (1 + y)^-2 ~ sum of a_j exp(-b_j y), isotropic and anisotropic alike, any alpha.
// Relative L2 error .140, .042, .014, .0053 for 1..4 terms. Rows: terms of count 1, 2, 3, 4 one after another, each (a, b).
CONST Real kGgxTerms[20] = {
    Real(0.85981), Real(1.13113),
    Real(0.80778), Real(1.62945), Real(0.12183), Real(0.27120),
    Real(0.68915), Real(2.19770), Real(0.26784), Real(0.55450), Real(0.01720), Real(0.09326),
    Real(0.55243), Real(2.70405), Real(0.37777), Real(0.83980), Real(0.05652), Real(0.21517), Real(0.00275), Real(0.03622)};

// (a, b) of term `index` of `count`; count in 1..4, index in 0..count-1.
FN Vec2 ggxMixtureTerm(IN(int) count, IN(int) index) {
  int at = count * (count - 1) + 2 * index;
  return Vec2(kGgxTerms[at], kGgxTerms[at + 1]);
}

// Mixture (B): the peak-1 isotropic distribution as SGs about n, amplitude exp(p(alpha)), sharpness 2 k exp(q(alpha)).
// Polynomials for ln amplitude and ln b, alpha in [.01, .99]; relative L2 error at most .201, .056, .017, .0083 for 1..4 lobes.
// Rows as above: five coefficients of ln amplitude, then five of ln b.
CONST Real kGgxLobes[100] = {
    -Real(0.17545), Real(0.58023), -Real(3.22222), Real(4.56556), -Real(1.73810),
    Real(0.05842), Real(0.69595), -Real(3.64326), Real(3.21764), -Real(0.23382),

    -Real(0.22772), Real(0.59416), -Real(3.56035), Real(7.88553), -Real(6.46419),
    Real(0.51162), -Real(0.92700), Real(1.77539), Real(0.36722), Real(0.40137),
    -Real(1.99135), -Real(4.05830), Real(11.60031), -Real(5.88081), Real(0.15283),
    -Real(1.24548), -Real(2.38468), Real(3.62754), -Real(1.15598), -Real(1.01597),

    -Real(0.37260), Real(0.69484), -Real(4.66569), Real(11.40561), -Real(15.21901),
    Real(0.77912), -Real(0.39872), Real(0.70992), Real(4.08131), -Real(2.43237),
    -Real(1.32769), -Real(1.08777), Real(3.13351), Real(6.89356), -Real(9.47625),
    -Real(0.60320), -Real(1.07088), Real(3.12325), Real(2.90909), -Real(2.30925),
    -Real(4.08917), -Real(4.20084), Real(21.72262), -Real(17.97322), Real(4.37579),
    -Real(2.39311), -Real(2.42672), Real(5.11251), -Real(4.52322), -Real(19.69534),

    -Real(0.46298), -Real(1.95300), Real(4.66927), -Real(2.56820), -Real(6.49966),
    Real(0.87782), Real(2.12540), -Real(9.48400), Real(20.01962), -Real(12.39418),
    -Real(1.15006), Real(3.43056), -Real(16.84459), Real(33.91682), -Real(21.35488),
    -Real(0.37608), Real(3.08028), -Real(9.53721), Real(13.37668), -Real(4.25254),
    -Real(3.35667), Real(6.78519), -Real(17.16554), Real(27.79074), -Real(23.57423),
    -Real(1.83957), Real(3.76878), -Real(10.12591), Real(20.92099), -Real(16.44990),
    -Real(6.63469), Real(6.35077), Real(3.34516), -Real(2.51795), -Real(0.68426),
    -Real(3.70854), Real(2.75506), -Real(13.07784), Real(27.32363), -Real(73.40752)};

FN Real ggxLobePolynomial(IN(int) row, IN(Real) a) {
  return kGgxLobes[row] + a * (kGgxLobes[row + 1] + a * (kGgxLobes[row + 2] + a * (kGgxLobes[row + 3] + a * kGgxLobes[row + 4])));
}

// (amplitude, sharpness) of lobe `index` of `count`; count in 1..4. alpha above .99 is taken as .99; the sharpness is at most 1e6.
// The distribution itself is this over pi alpha^2.
FN Vec2 ggxMixtureLobe(IN(Real) alpha, IN(int) count, IN(int) index) {
  Real a = clampReal(alpha, kMinAlpha, Real(0.99));
  int row = 5 * (count * (count - 1) + 2 * index);
  Real sharpness = Real(2.0) * ggxCurvature(a) * exp(ggxLobePolynomial(row + 5, a));
  return Vec2(exp(ggxLobePolynomial(row, a)), clampReal(sharpness, Real(0.0), Real(1.0e6)));
}
