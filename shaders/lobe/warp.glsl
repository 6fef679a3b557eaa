// From a lobe of half vectors (an NDF's) to a lobe of light directions, for a viewer along wo. Wang et al. 2009, ALGORITHMS 2.3.
// Mirroring wo about h turns a small step of h in the plane of incidence into twice that step of wi, and a step across it into
// 2 cos times, cos = dot(wo, h): the warped lobe is elongated, the more so at grazing angles.
#ifndef CHIARO_CPP
#include "shaders/lobe/sg.glsl"
#include "shaders/lobe/warp_choice.glsl"
#endif

// The warp is clamped here: below, the true lobe keeps its width in the plane of incidence while the formulas would make a needle.
CONST Real kMinWarpCosine = Real(0.1);

// |dot(wo, p)| in [kMinWarpCosine, 1].
FN Real warpCosine(IN(Vec3) wo, IN(Vec3) halfAxis) { return clampReal(abs(dot(wo, halfAxis)), kMinWarpCosine, Real(1.0)); }

// wo mirrored about p: 2 dot(wo, p) p - wo.
FN Vec3 warpAxis(IN(Vec3) wo, IN(Vec3) halfAxis) { return Real(2.0) * dot(wo, halfAxis) * halfAxis - wo; }

// One round lobe of sharpness l / (4 cos): right integral, wrong shape off normal incidence; squared error 2 (1 - sqrt c)^2 / (1 + c).
FN SphericalGaussian sgWarpIsotropic(IN(SphericalGaussian) halfLobe, IN(Vec3) wo) {
  Real c = warpCosine(wo, halfLobe.axis);
  return sphericalGaussian(warpAxis(wo, halfLobe.axis), halfLobe.sharpness / (Real(4.0) * c), halfLobe.amplitude);
}

// The direction u, across the mirror direction and in the plane of wo and p, in which a tilt of p away from the viewer moves it; 0 where wo
// is along p. The part of wo across p comes from wo -+ p, which is exact where wo is nearly +-p.
FN Vec3 warpTangent(IN(Vec3) wo, IN(Vec3) p) {
  Real cosine = dot(wo, p);
  Vec3 e = cosine < Real(0.0) ? wo + p : wo - p;
  Vec3 tangent = e - dot(e, p) * p;
  Real sine = sqrt(dot(tangent, tangent));
  Vec3 m = sine == Real(0.0) ? Vec3(Real(0.0), Real(0.0), Real(0.0)) : tangent / sine;
  return -(sine * p + cosine * m);
}

// Anisotropic spherical Gaussian (Xu et al. 2013): amplitude max(w.z, 0) exp(-sharpnessX (w.x)^2 - sharpnessY (w.y)^2), x, y, z orthonormal.
struct AnisotropicGaussian {
  Vec3 x;
  Vec3 y;
  Vec3 z;
  Real sharpnessX;
  Real sharpnessY;
  Real amplitude;
};

FN Real asgEvaluate(IN(AnisotropicGaussian) g, IN(Vec3) direction) {
  Real x = dot(direction, g.x);
  Real y = dot(direction, g.y);
  return g.amplitude * max(dot(direction, g.z), Real(0.0)) * exp(-g.sharpnessX * x * x - g.sharpnessY * y * y);
}

// Integral over the sphere, amplitude pi / sqrt(sharpnessX sharpnessY); 1 % too large where both are 5, 58 % at 1.
FN Real asgIntegral(IN(AnisotropicGaussian) g) { return g.amplitude * kPi / (sqrt(g.sharpnessX) * sqrt(g.sharpnessY)); }

// One elongated lobe, exact in the limit of sharp lobes: sharpness l / 8 in the plane of incidence, l / (8 cos^2) across. Worse than the round
// one for lobes broader than about sharpness 6. To be evaluated: no closed form integrates it against the SG light and visibility of a pixel.
FN AnisotropicGaussian sgWarpAnisotropic(IN(SphericalGaussian) halfLobe, IN(Vec3) wo) {
  Real c = warpCosine(wo, halfLobe.axis);
  AnisotropicGaussian g;
  g.z = warpAxis(wo, halfLobe.axis);
  Vec3 u = warpTangent(wo, halfLobe.axis);
  if (!(dot(u, u) > Real(0.5))) {
    // Along the axis any tangent will do: the lobe is round.
    u = cross(abs(g.z.x) < Real(0.7) ? Vec3(Real(1.0), Real(0.0), Real(0.0)) : Vec3(Real(0.0), Real(1.0), Real(0.0)), g.z);
    u = u / sqrt(dot(u, u));
  }
  g.x = u;
  g.y = cross(g.z, u);
  g.sharpnessX = Real(0.125) * halfLobe.sharpness;
  g.sharpnessY = Real(0.125) * halfLobe.sharpness / (c * c);
  g.amplitude = halfLobe.amplitude;
  return g;
}

// Three or five round lobes strung along the plane of incidence, L2-optimal, by c = cos from .1 to 1 in steps of .1:
// width s, spacing in units of the lobe's deviation 2 / sqrt(l), amplitudes from the middle out, and the energy they keep.
CONST Real kWarp3[50] = {
    Real(0.1799), Real(0.6079), Real(0.8699), Real(0.7494), Real(0.767),
    Real(0.2697), Real(0.7851), Real(0.9706), Real(0.7460), Real(0.896),
    Real(0.3493), Real(0.9019), Real(0.9768), Real(0.6708), Real(0.943),
    Real(0.4289), Real(0.9857), Real(0.9459), Real(0.5762), Real(0.965),
    Real(0.5135), Real(1.0403), Real(0.8977), Real(0.4793), Real(0.979),
    Real(0.6046), Real(1.0588), Real(0.8434), Real(0.3897), Real(0.989),
    Real(0.7011), Real(1.0275), Real(0.7907), Real(0.3135), Real(0.995),
    Real(0.8001), Real(0.9270), Real(0.7434), Real(0.2523), Real(0.999),
    Real(0.9000), Real(0.7158), Real(0.7023), Real(0.2043), Real(1.000),
    Real(1.0000), Real(0.0000), Real(0.6320), Real(0.1840), Real(1.000)};
CONST Real kWarp5[60] = {
    Real(0.1452), Real(0.4592), Real(0.9784), Real(0.8769), Real(0.6707), Real(0.859),
    Real(0.2272), Real(0.6054), Real(1.0076), Real(0.8260), Real(0.5009), Real(0.945),
    Real(0.3110), Real(0.7135), Real(0.9435), Real(0.7059), Real(0.3297), Real(0.972),
    Real(0.4031), Real(0.7945), Real(0.8569), Real(0.5826), Real(0.2027), Real(0.986),
    Real(0.5007), Real(0.8427), Real(0.7765), Real(0.4797), Real(0.1231), Real(0.994),
    Real(0.6002), Real(0.8532), Real(0.7100), Real(0.3996), Real(0.0763), Real(0.998),
    Real(0.7000), Real(0.8214), Real(0.6562), Real(0.3371), Real(0.0484), Real(0.999),
    Real(0.8000), Real(0.7363), Real(0.6125), Real(0.2874), Real(0.0313), Real(1.000),
    Real(0.9000), Real(0.5665), Real(0.5765), Real(0.2469), Real(0.0204), Real(1.000),
    Real(1.0000), Real(0.0000), Real(0.5190), Real(0.2220), Real(0.0184), Real(1.000)};

// Column `column` of the table for `count` lobes (3 or 5) at cosine c, linear between rows.
// Columns: 0 width, 1 spacing, 2 + |k| amplitude of the k-th lobe from the middle, last energy.
FN Real warpTable(IN(Real) c, IN(int) count, IN(int) column) {
  // NaN goes to row 0 as an index (converting it would be undefined) and comes back through the fraction.
  Real safe = c >= Real(0.1) ? (c <= Real(1.0) ? c : Real(1.0)) : Real(0.1);
  int row = int(Real(10.0) * safe) - 1;
  if (row < 0) row = 0;
  if (row > 8) row = 8;
  Real fraction = Real(10.0) * c - Real(row + 1);
  int stride = count == 5 ? 6 : 5;
  int at = stride * row + column;
  Real from = count == 5 ? kWarp5[at] : kWarp3[at];
  Real to = count == 5 ? kWarp5[at + stride] : kWarp3[at + stride];
  return from + (to - from) * fraction;
}

// Share of the lobe's integral that the `count` lobes keep at this angle: divide amplitudes by it when energy matters more
// than the least L2 error.
FN Real sgWarpEnergy(IN(Real) c, IN(int) count) { return warpTable(clampReal(c, kMinWarpCosine, Real(1.0)), count, count == 5 ? 5 : 4); }

// Lobe `index` of `count` (1: isotropic; 3 or 5), index in 0..count-1, strung from the viewer's side outwards. Squared error at
// c = .5: .114, .0036, 1.5e-4. Made for sharp lobes: below sharpness 16 the offsets stay those of 16, at most 1.1 radian.
FN SphericalGaussian sgWarpLobe(IN(SphericalGaussian) halfLobe, IN(Vec3) wo, IN(int) count, IN(int) index) {
  if (count == 1) return sgWarpIsotropic(halfLobe, wo);
  Real l = clampSharpness(halfLobe.sharpness);
  if (isNotANumber(l)) return sphericalGaussian(halfLobe.axis, l, l);
  Vec3 p = halfLobe.axis;
  Real c = warpCosine(wo, p);
  int k = index - (count - 1) / 2;
  int distance = k < 0 ? -k : k;
  Real width = warpTable(c, count, 0);
  Real amplitude = warpTable(c, count, 2 + distance);
  Real sharpness = Real(0.25) * l / (width * width);

  Vec3 r = warpAxis(wo, p);
  Vec3 u = warpTangent(wo, p);

  Real deviation = l < Real(16.0) ? Real(0.5) : Real(2.0) / sqrt(l);
  Real angle = Real(k) * warpTable(c, count, 1) * deviation;
  Vec3 axis = sinQuarter(kHalfPi - abs(angle)) * r + sinQuarter(angle) * u;
  return sphericalGaussian(axis, sharpness, halfLobe.amplitude * amplitude);
}

// Ways to warp.
CONST int kWarpIsotropic = 0;
CONST int kWarpAnisotropic = 1;
CONST int kWarpThree = 2;
CONST int kWarpFive = 3;

// The way of least measured error for a half-vector lobe of this sharpness at c = dot(wo, axis). `closedForm`: only ways whose integrals
// against SG light and visibility are known, round lobes. Nearest entry of the table.
FN int warpChoice(IN(Real) sharpness, IN(Real) c, IN(bool) closedForm) {
  int row = int(clampReal(log(max(sharpness, Real(1.0))) * Real(1.44269504) + Real(0.5), Real(0.0), Real(16.0)));
  int column = int(clampReal(Real(10.0) * c - Real(0.5), Real(0.0), Real(9.0)));
  return kWarpChoices[(closedForm ? 170 : 0) + 10 * row + column];
}

// How many lobes a way takes.
FN int warpLobeCount(IN(int) way) { return way == kWarpThree ? 3 : way == kWarpFive ? 5 : 1; }
