// Any reflectance model as round lobes over light directions, no table of the model needed: for brushed, anisotropic and user-made ones. Distribution
// and warp together make an elongated lobe of light; round lobes are strung along it, mirrored one by one, and their amplitudes fitted to the
// reflectance at their own axes. (Round models are served better by reflectance.glsl.)
#ifndef CHIARO_CPP
#include "shaders/lobe/reflectance.glsl"
#endif

// As kWarp3 and kWarp5 in warp.glsl, for seven and nine lobes; c is the ratio of the short to the long deviation, .1 to 1. Squared error at
// c = .1, .2, .3: .10, .011, .0009 and .056, .003, .0001.
CONST Real kWarp7[70] = {
    Real(0.1280), Real(0.3817), Real(1.0166), Real(0.9451), Real(0.7540), Real(0.5591), Real(0.9063),
    Real(0.2105), Real(0.5139), Real(0.9653), Real(0.8432), Real(0.5516), Real(0.3055), Real(0.9672),
    Real(0.3021), Real(0.6166), Real(0.8491), Real(0.6919), Real(0.3645), Real(0.1418), Real(0.9875),
    Real(0.4003), Real(0.6902), Real(0.7488), Real(0.5667), Real(0.2387), Real(0.0634), Real(0.9961),
    Real(0.5000), Real(0.7322), Real(0.6733), Real(0.4732), Real(0.1598), Real(0.0291), Real(0.9989),
    Real(0.6000), Real(0.7419), Real(0.6155), Real(0.4022), Real(0.1093), Real(0.0138), Real(0.9998),
    Real(0.7000), Real(0.7154), Real(0.5699), Real(0.3466), Real(0.0760), Real(0.0067), Real(1.0000),
    Real(0.8000), Real(0.6425), Real(0.5330), Real(0.3018), Real(0.0534), Real(0.0033), Real(1.0000),
    Real(0.9000), Real(0.4952), Real(0.5027), Real(0.2649), Real(0.0377), Real(0.0016), Real(1.0000),
    Real(1.0000), Real(0.0000), Real(0.4780), Real(0.2358), Real(0.0247), Real(0.0005), Real(1.0000)};
CONST Real kWarp9[80] = {
    Real(0.1178), Real(0.3333), Real(1.0232), Real(0.9673), Real(0.8182), Real(0.6130), Real(0.4519), Real(0.9332),
    Real(0.2037), Real(0.4580), Real(0.9063), Real(0.8119), Real(0.5868), Real(0.3338), Real(0.1759), Real(0.9803),
    Real(0.3004), Real(0.5539), Real(0.7711), Real(0.6506), Real(0.3939), Real(0.1663), Real(0.0579), Real(0.9950),
    Real(0.4000), Real(0.6196), Real(0.6745), Real(0.5361), Real(0.2709), Real(0.0851), Real(0.0192), Real(0.9990),
    Real(0.5000), Real(0.6562), Real(0.6048), Real(0.4535), Real(0.1921), Real(0.0452), Real(0.0066), Real(0.9998),
    Real(0.6000), Real(0.6627), Real(0.5509), Real(0.3907), Real(0.1397), Real(0.0249), Real(0.0024), Real(1.0000),
    Real(0.7000), Real(0.6360), Real(0.5076), Real(0.3413), Real(0.1039), Real(0.0142), Real(0.0009), Real(1.0000),
    Real(0.8000), Real(0.5688), Real(0.4728), Real(0.3016), Real(0.0784), Real(0.0082), Real(0.0004), Real(1.0000),
    Real(0.9000), Real(0.4652), Real(0.4727), Real(0.2680), Real(0.0483), Real(0.0029), Real(0.0000), Real(1.0000),
    Real(1.0000), Real(0.0000), Real(0.4400), Real(0.2420), Real(0.0360), Real(0.0020), Real(0.0000), Real(1.0000)};

// Column `column` (0 width, 1 spacing, 2 + |k| amplitude) for 3, 5, 7 or 9 lobes.
FN Real stringTable(IN(Real) c, IN(int) count, IN(int) column) {
  if (count <= 5) return warpTable(c, count, column);
  Real safe = c >= Real(0.1) ? (c <= Real(1.0) ? c : Real(1.0)) : Real(0.1);
  int row = int(Real(10.0) * safe) - 1;
  if (row < 0) row = 0;
  if (row > 8) row = 8;
  int stride = count == 7 ? 7 : 8;
  int at = stride * row + column;
  Real from = count == 7 ? kWarp7[at] : kWarp9[at];
  Real to = count == 7 ? kWarp7[at + stride] : kWarp9[at + stride];
  return from + (to - from) * (Real(10.0) * safe - Real(row + 1));
}

// The elongated lobe of light that a distribution of half-vector sharpnesses (x, y) about n makes for a viewer.
struct LightString {
  Vec3 along;       // in the tangent plane: half vectors move this way
  Real step;        // and by this angle for one long deviation of the lobe of light
  Real least;       // sharpness along the lobe
  Real ratio;       // short over long deviation, (0, 1]
  Real acrossPlane; // 1: the short direction lies across the plane of incidence, 0: in it
};

FN LightString lightString(IN(Real) sharpnessX, IN(Real) sharpnessY, IN(Vec3) wo) {
  Real c = clampReal(wo.z, kMinWarpCosine, Real(1.0));
  Real sine = sqrt(wo.x * wo.x + wo.y * wo.y);
  Real px = sine > Real(1.0e-6) ? wo.x / sine : Real(1.0);
  Real py = sine > Real(1.0e-6) ? wo.y / sine : Real(0.0);
  // The quadratic form of the exponent in (plane of incidence, across): half vectors' through the mirror's Jacobian diag(1/2, 1/(2c)).
  Real xx = Real(0.25) * (sharpnessX * px * px + sharpnessY * py * py);
  Real yy = Real(0.25) * (sharpnessX * py * py + sharpnessY * px * px) / (c * c);
  Real xy = Real(0.25) * (sharpnessY - sharpnessX) * px * py / c;
  Real spread = Real(0.5) * (xx - yy);
  Real most = Real(0.5) * (xx + yy) + sqrt(spread * spread + xy * xy);
  LightString s;
  s.least = Real(0.0625) * (sharpnessX / c) * (sharpnessY / c) / most;  // the determinant over the other eigenvalue: nothing cancels
  s.ratio = clampReal(sqrt(s.least / most), Real(0.0), Real(1.0));
  Real ex = xx > yy ? -xy : yy - s.least;
  Real ey = xx > yy ? xx - s.least : -xy;
  Real size = sqrt(ex * ex + ey * ey);
  ex = size > Real(1.0e-6) * most ? ex / size : Real(1.0);
  ey = size > Real(1.0e-6) * most ? ey / size : Real(0.0);
  s.acrossPlane = ex * ex;
  Real hx = Real(0.5) * ex;
  Real hy = Real(0.5) * ey / c;
  Real h = sqrt(hx * hx + hy * hy);
  s.step = h / sqrt(s.least);
  s.along = Vec3((hx * px - hy * py) / h, (hx * py + hy * px) / h, Real(0.0));
  return s;
}

// Lobe `index` of `count` (3, 5, 7 or 9); amplitude for a distribution of peak 1 without the smooth factor. 0 below the horizon.
FN SphericalGaussian lightStringLobe(IN(LightString) s, IN(Vec3) wo, IN(int) count, IN(int) index) {
  int k = index - (count - 1) / 2;
  Real width = stringTable(s.ratio, count, 0);
  Real angle = clampReal(Real(k) * stringTable(s.ratio, count, 1) * s.step, -Real(1.5), Real(1.5));
  Vec3 wh = sinQuarter(kHalfPi - abs(angle)) * Vec3(Real(0.0), Real(0.0), Real(1.0)) + sinQuarter(angle) * s.along;
  Real cosine = dot(wo, wh);
  Real sharpness = s.least / (width * width);
  // A lobe across the plane of incidence is as wide as its own half vector makes it, 2 cos.
  Real stretch = clampReal(wo.z, kMinWarpCosine, Real(1.0)) / max(cosine, kMinWarpCosine);
  sharpness = sharpness * (Real(1.0) + s.acrossPlane * (stretch * stretch - Real(1.0)));
  Vec3 axis = warpAxis(wo, wh);
  bool seen = cosine > Real(0.02) && axis.z > Real(0.0);
  return sphericalGaussian(axis, sharpness, seen ? stringTable(s.ratio, count, 2 + (k < 0 ? -k : k)) : Real(0.0));
}

// rho (n.wi), F = 1, as `count` lobes (3, 5, 7 or 9): lobes[0 .. count-1]. GGX has tails that no one string follows: it is asked for by term,
// ggxMixtureTerm(terms, term) of 1 to 4, and is the sum over its terms; other models have one (terms 1, term 0).
// Two sweeps of a_k <- a_k f(axis_k) / sum_j a_j G_j(axis_k) bring the sum to the reflectance at every axis; amplitudes stay positive.
FN void elongatedLobes(IN(ReflectanceModel) m, IN(Vec3) wo, IN(int) count, IN(int) terms, IN(int) term, OUT_ARRAY(SphericalGaussian, lobes, 9)) {
  Vec2 part = ggxMixtureTerm(terms, term);
  Real lx = m.kind == kGgx ? Real(2.0) * part.y * ggxCurvature(m.x) + kBroadestHalfLobe : max(ndfBestLobe(m.kind, m.x).y, Real(0.5));
  Real ly = m.kind == kGgx ? Real(2.0) * part.y * ggxCurvature(m.y) + kBroadestHalfLobe : max(ndfBestLobe(m.kind, m.y).y, Real(0.5));
  LightString s = lightString(lx, ly, wo);
  Real wanted[9];
  for (int k = 0; k < count; ++k) {
    lobes[k] = lightStringLobe(s, wo, count, k);
    bool seen = lobes[k].amplitude > Real(0.0);
    wanted[k] = Real(0.0);
    if (seen && m.kind == kGgx) {
      Vec3 wh = halfVector(wo, lobes[k].axis);
      Real y = ggxCurvature(m.x) * wh.x * wh.x + ggxCurvature(m.y) * wh.y * wh.y;
      wanted[k] = part.x * vanishingExp(part.y * y) * smoothTimesCosine(m, wo, lobes[k].axis);
    } else if (seen) {
      wanted[k] = modelTimesCosine(m, wo, lobes[k].axis);
    }
    lobes[k].amplitude = wanted[k];
  }
  for (int sweep = 0; sweep < 2; ++sweep) {
    Real next[9];
    for (int k = 0; k < count; ++k) {
      Real sum = Real(0.0);
      for (int j = 0; j < count; ++j) sum += sgEvaluate(lobes[j], lobes[k].axis);
      next[k] = sum > Real(0.0) ? lobes[k].amplitude * (wanted[k] / sum) : Real(0.0);
    }
    for (int k = 0; k < count; ++k) lobes[k].amplitude = next[k];
  }
}
