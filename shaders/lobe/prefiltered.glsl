// Where a lobe's visible fraction is read: broad lobes from maps of prefiltered visibility, sharp ones from the SSDF.
#ifndef CHIARO_CPP
#include "shaders/lobe/ssdf.glsl"
#endif

// The SSDF comes in from kSsdfFrom to kSsdfAlone times the sharpest level's sharpness; in between its errors and the level's cancel in part
// (measured on the built-in scene, compressed, at sharpness 100: .022 from levels alone, .019 so), and a smooth passage shows no seam.
CONST Real kSsdfFrom = Real(0.5);
CONST Real kSsdfAlone = Real(1.6);

struct VisibilitySource {
  int level;    // the broader of the two levels
  Real next;    // share of level + 1, [0, 1]
  Real ssdf;    // share of the SSDF, [0, 1]; 1: no level is read
};

// levels >= 1 maps of sharpness first, first * ratio, ...; lobes broader than the first read the first. first > 0, ratio > 1; sharpness
// in [0, 1e6] (NaN reads the SSDF).
FN VisibilitySource visibilitySource(IN(Real) sharpness, IN(int) levels, IN(Real) first, IN(Real) ratio) {
  VisibilitySource source;
  Real last = Real(levels - 1);
  Real above = log(clampReal(sharpness, first * Real(1.0e-6), kMaxSharpness) / first);  // of the first level's sharpness, in logarithms
  Real t = clampReal((above - last * log(ratio) - log(kSsdfFrom)) / log(kSsdfAlone / kSsdfFrom), Real(0.0), Real(1.0));
  source.ssdf = sharpness <= Real(1.0e30) ? t * t * (Real(3.0) - Real(2.0) * t) : Real(1.0);  // NaN: alone
  Real position = above / log(ratio);
  if (!(position < last)) {
    source.level = levels - 1;
    source.next = Real(0.0);
    return source;
  }
  position = clampReal(position, Real(0.0), last);
  source.level = int(floor(position));
  source.next = position - Real(source.level);
  return source;
}
