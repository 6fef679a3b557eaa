// A view slice of a round reflectance model as SG lobes over light directions, from the table of runtime/brdf/reflectance_table.h: lobes in the
// plane of incidence and pairs mirrored about it. As in specular.glsl a lobe holds its share of the albedo:
//   Lo += (f0 * weight + fresnelWeight) * (mean of light * visibility over the normalised lobe).
#ifndef CHIARO_CPP
#include "shaders/lobe/ndf.glsl"
#include "shaders/lobe/specular.glsl"
#endif

// Five in the plane and two pairs; GGX, whose tail is long, takes ten and three.
FN int reflectanceSingles(IN(int) kind) { return kind == kGgx ? 10 : 5; }
FN int reflectancePairs(IN(int) kind) { return kind == kGgx ? 3 : 2; }
FN int reflectanceLobeCount(IN(int) kind) { return reflectanceSingles(kind) + 2 * reflectancePairs(kind); }
// vec4 per texel: singles, pairs, then the pairs' elevations.
FN int reflectanceEntries(IN(int) kind) { return reflectanceSingles(kind) + reflectancePairs(kind) + 1; }

// The table spans these widths; below, a slice only scales.
CONST Real kMinTableWidth = Real(0.01);
CONST Real kMaxTableWidth = Real(1.0);

// A lobe's width as that of a Gaussian of the slope, e^(-tan^2 / width^2), whatever the model calls it.
FN Real modelWidth(IN(int) kind, IN(Real) parameter) { return modelHasExponent(kind) ? sqrt(Real(2.0) / (parameter + Real(1.0))) : parameter; }

// Table coordinates in [0, 1]^2, first and last texel's centres at 0 and 1: root of the width, root of the cosine to the viewer.
FN Vec2 reflectanceTableCoordinate(IN(Real) width, IN(Real) cosineOut) {
  Real least = sqrt(kMinTableWidth);
  return Vec2((sqrt(clampReal(width, kMinTableWidth, kMaxTableWidth)) - least) / (sqrt(kMaxTableWidth) - least),
              sqrt(clampReal(cosineOut, Real(0.0), Real(1.0))));
}

// entry: (angle from the mirror direction away from n over width, log2(sharpness width^2), weight, fresnelWeight) of one lobe; `elevation`
// (over width) turns it out of the plane of incidence towards y. x = incidenceTangent(n, wo), y = cross(n, x); cosineOut = dot(n, wo) > 0.
FN SpecularLobe reflectanceTableLobe(IN(Vec4) entry, IN(Real) elevation, IN(Vec3) n, IN(Vec3) x, IN(Vec3) y, IN(Real) cosineOut, IN(Real) width) {
  Real w = clampReal(width, kMinAlpha, kMaxTableWidth);
  Real sine = sqrt(max(Real(0.0), (Real(1.0) - cosineOut) * (Real(1.0) + cosineOut)));
  Vec3 mirror = n * cosineOut - x * sine;
  Vec3 outwards = -(n * sine + x * cosineOut);
  Real angle = entry.x * w;
  Real tilt = elevation * w;
  SpecularLobe lobe;
  lobe.axis = (mirror * cos(angle) + outwards * sin(angle)) * cos(tilt) + y * sin(tilt);
  lobe.sharpness = pow(Real(2.0), entry.y) / (w * w);
  lobe.weight = entry.z;
  lobe.fresnelWeight = entry.w;
  return lobe;
}
