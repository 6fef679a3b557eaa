// Which samples of a coarse grid, or of the frame before, may stand for a pixel: by how alike the lobes are that light comes through
// (Tokuyoshi 2015, eq. 4: sgNormalizedInnerProduct), and the baseline by how alike the normals are. ALGORITHMS 5.1.
#ifndef CHIARO_CPP
#include "shaders/lobe/warp.glsl"
#include "shaders/lobe/ndf.glsl"
#endif

// The SG of the clamped cosine: what diffuse light comes through, about the normal.
CONST Real kDiffuseSharpness = Real(2.1);
// Of the normal-based weight (Yang et al. 2008, with the value of Tokuyoshi 2015).
CONST Real kNormalVariance = Real(0.005);

// The lobe of a model's reflection: its distribution of half vectors as one SG about the normal, warped about the view. `width` is a width or an
// exponent, of an elongated distribution the narrower direction's. Amplitude 1. No longer grows sharper where the view is within .1 of grazing.
FN SphericalGaussian reflectionLobe(IN(int) kind, IN(Real) width, IN(Vec3) n, IN(Vec3) wo) {
  return sgWarpIsotropic(sphericalGaussian(n, ndfBestLobe(kind, width).y, Real(1.0)), wo);
}

// Likeness of two lobes in [0, 1], whatever their sharpness.
FN Real lobeWeight(IN(Vec3) axis1, IN(Real) sharpness1, IN(Vec3) axis2, IN(Real) sharpness2) {
  return sgNormalizedInnerProduct(sphericalGaussian(axis1, sharpness1, Real(1.0)), sphericalGaussian(axis2, sharpness2, Real(1.0)));
}

// -log of lobeWeight, which tells lobes apart long after that is 0: (sharpness / 4) |axis1 - axis2|^2 of two as sharp.
FN Real lobeDistance(IN(Vec3) axis1, IN(Real) sharpness1, IN(Vec3) axis2, IN(Real) sharpness2) {
  SphericalGaussian p = sgProductLog(axis1, sharpness1, axis2, sharpness2);
  Real both = oneMinusExpOver(Real(2.0) * p.sharpness);
  // Of ratios, as the logarithms of all three would cancel.
  Real one = oneMinusExpOver(Real(4.0) * clampSharpness(sharpness1)) / both, other = oneMinusExpOver(Real(4.0) * clampSharpness(sharpness2)) / both;
  Real distance = Real(0.5) * (log(one) + log(other)) - p.amplitude;
  return distance > Real(0.0) ? distance : (isNotANumber(distance) ? distance : Real(0.0));
}

// For a choice among samples of which none may be alike: in (0, 1], falls with the square of the angle and never to 0. What lies between two
// samples turns lobes by more than sharp ones are wide, so that all count as wide as that at least.
CONST Real kTurnSharpness = Real(33.0);
CONST Real kNearDistance = Real(0.02);
FN Real turnedSharpness(IN(Real) sharpness) {
  Real s = clampSharpness(sharpness);
  return s / (Real(1.0) + s / kTurnSharpness);
}
FN Real lobeNearness(IN(Vec3) axis1, IN(Real) sharpness1, IN(Vec3) axis2, IN(Real) sharpness2) {
  return kNearDistance / (kNearDistance + lobeDistance(axis1, turnedSharpness(sharpness1), axis2, turnedSharpness(sharpness2)));
}

// The same of two normals, which knows nothing of sharpness: exp(-|n1 - n2|^2 / (2 variance)).
FN Real normalWeight(IN(Vec3) n1, IN(Vec3) n2) {
  Vec3 difference = n1 - n2;
  return exp(-dot(difference, difference) / (Real(2.0) * kNormalVariance));
}

// How alike a depth is to what the pixel's plane says it should be there: `off` by how much it is not, in units of what is let through.
FN Real depthWeight(IN(Real) off) { return exp(-Real(0.5) * off * off); }
