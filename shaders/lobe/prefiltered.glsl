// Where a lobe's visible fraction is read: broad lobes from maps of prefiltered visibility, sharp ones from the SSDF.
#ifndef CHIARO_CPP
#include "shaders/lobe/ssdf.glsl"
#endif

// Lobes this many times sharper than the sharpest level read the SSDF alone. Between, both are close (measured on the built-in scene:
// .009 the level, .021 the SSDF at the level's own sharpness, .011 the SSDF at 2.3 times it), so a smooth passage shows no seam.
CONST Real kSsdfFrom = Real(1.6);

struct VisibilitySource {
  int level;    // the broader of the two levels
  Real next;    // share of level + 1, [0, 1]
  Real ssdf;    // share of the SSDF, [0, 1]; 1: no level is read
};

// levels >= 1 maps of sharpness first, first * ratio, ...; lobes broader than the first read the first. first > 0, ratio > 1; sharpness
// in [0, 1e6] (NaN reads the SSDF).
FN VisibilitySource visibilitySource(IN(Real) sharpness, IN(int) levels, IN(Real) first, IN(Real) ratio) {
  VisibilitySource source;
  source.level = 0;
  source.next = Real(0.0);
  source.ssdf = Real(0.0);
  Real last = Real(levels - 1);
  Real position = sharpness <= first ? Real(0.0) : log(sharpness / first) / log(ratio);  // NaN stays one
  if (!(position < last)) {
    Real t = clampReal((position - last) * log(ratio) / log(kSsdfFrom), Real(0.0), Real(1.0));
    source.level = levels - 1;
    source.ssdf = sharpness <= Real(1.0e30) ? t * t * (Real(3.0) - Real(2.0) * t) : Real(1.0);
    return source;
  }
  source.level = int(floor(position));
  source.next = position - Real(source.level);
  return source;
}
