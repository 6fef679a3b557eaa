// From linear Rec.709 radiance to what an sRGB screen shows.
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

// Numbers of the tone maps (assets/image/display.h names them).
CONST int kToneMapNeutral = 0;
CONST int kToneMapAces = 1;
CONST int kToneMapClamp = 2;

FN Real largestOf(IN(Vec3) c) { return max(c.x, max(c.y, c.z)); }
FN Real smallestOf(IN(Vec3) c) { return min(c.x, min(c.y, c.z)); }

// Khronos PBR Neutral: base colours below .8 pass unchanged but for the .04 that a dielectric adds; only highlights are compressed and
// then desaturated.
FN Vec3 toneMapNeutral(IN(Vec3) color) {
  Real kStart = Real(0.8 - 0.04);
  Real floorValue = smallestOf(color);
  Real offset = floorValue < Real(0.08) ? floorValue - Real(6.25) * floorValue * floorValue : Real(0.04);
  Vec3 shifted = color - Vec3(offset, offset, offset);
  Real peak = largestOf(shifted);
  if (peak < kStart) return shifted;
  Real room = Real(1.0) - kStart;
  Real newPeak = Real(1.0) - room * room / (peak + room - kStart);
  Real keep = Real(1.0) / (Real(0.15) * (peak - newPeak) + Real(1.0));
  return shifted * (newPeak / peak) * keep + Vec3(newPeak, newPeak, newPeak) * (Real(1.0) - keep);
}

// S. Hill's fit of the ACES reference rendering and sRGB output transforms: matrix, rational curve, matrix.
FN Vec3 toneMapAces(IN(Vec3) color) {
  Vec3 v = Vec3(Real(0.59719) * color.x + Real(0.35458) * color.y + Real(0.04823) * color.z,
                Real(0.07600) * color.x + Real(0.90834) * color.y + Real(0.01566) * color.z,
                Real(0.02840) * color.x + Real(0.13383) * color.y + Real(0.83777) * color.z);
  Vec3 one = Vec3(Real(1.0), Real(1.0), Real(1.0));
  Vec3 a = v * (v + one * Real(0.0245786)) - one * Real(0.000090537);
  Vec3 b = v * (v * Real(0.983729) + one * Real(0.4329510)) + one * Real(0.238081);
  Vec3 f = a / b;
  return Vec3(Real(1.60475) * f.x - Real(0.53108) * f.y - Real(0.07367) * f.z,
              -Real(0.10208) * f.x + Real(1.10813) * f.y - Real(0.00605) * f.z,
              -Real(0.00327) * f.x - Real(0.07276) * f.y + Real(1.07602) * f.z);
}

// The sRGB transfer function (IEC 61966-2-1), [0, 1] to [0, 1]; NaN stays NaN.
FN Real srgbEncode(IN(Real) linear) {
  if (isNotANumber(linear)) return linear;  // pow may lose it
  Real x = clampReal(linear, Real(0.0), Real(1.0));
  return x <= Real(0.0031308) ? Real(12.92) * x : Real(1.055) * pow(x, Real(1.0 / 2.4)) - Real(0.055);
}
FN Real srgbDecode(IN(Real) encoded) {
  if (isNotANumber(encoded)) return encoded;
  Real x = clampReal(encoded, Real(0.0), Real(1.0));
  return x <= Real(0.04045) ? x / Real(12.92) : pow((x + Real(0.055)) / Real(1.055), Real(2.4));
}

// radiance >= 0 times `exposure`, tone-mapped and encoded.
FN Vec3 displayEncode(IN(Vec3) radiance, IN(Real) exposure, IN(int) toneMap) {
  Vec3 c = radiance * exposure;
  if (toneMap == kToneMapNeutral) c = toneMapNeutral(c);
  if (toneMap == kToneMapAces) c = toneMapAces(c);
  return Vec3(srgbEncode(c.x), srgbEncode(c.y), srgbEncode(c.z));
}
