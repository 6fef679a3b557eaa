// Real spherical harmonics, bands l = 0..4, orthonormal over the sphere, z the pole, no Condon-Shortley sign (l = 1 is (y, z, x) with
// plus signs). Index l (l + 1) + m. `direction` unit: the polynomials use x^2 + y^2 + z^2 = 1.
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

CONST int kShCount = 25;

// All 25 values at once. In each the constant is the normalisation of that band and order.
FN void shEvaluate(IN(Vec3) direction, OUT_ARRAY(Real, basis, 25)) {
  Real x = direction.x;
  Real y = direction.y;
  Real z = direction.z;
  Real z2 = z * z;
  Real c2 = (x - y) * (x + y);                     // r^2 sin^2 cos 2 phi
  Real s2 = Real(2.0) * x * y;                     // r^2 sin^2 sin 2 phi
  Real c3 = x * (x * x - Real(3.0) * y * y);       // cos 3 phi
  Real s3 = y * (Real(3.0) * x * x - y * y);       // sin 3 phi
  Real c4 = c2 * c2 - s2 * s2;                     // cos 4 phi
  Real s4 = Real(2.0) * c2 * s2;                   // sin 4 phi
  basis[0] = Real(0.28209479177387814347);         // sqrt(1 / (4 pi))
  basis[1] = Real(0.48860251190291992159) * y;     // sqrt(3 / (4 pi))
  basis[2] = Real(0.48860251190291992159) * z;
  basis[3] = Real(0.48860251190291992159) * x;
  basis[4] = Real(0.54627421529603953527) * s2;    // sqrt(15 / (16 pi))
  basis[5] = Real(1.09254843059207907054) * y * z; // sqrt(15 / (4 pi))
  basis[6] = Real(0.31539156525252000603) * (Real(3.0) * z2 - Real(1.0));  // sqrt(5 / (16 pi))
  basis[7] = Real(1.09254843059207907054) * x * z;
  basis[8] = Real(0.54627421529603953527) * c2;
  basis[9] = Real(0.59004358992664351035) * s3;    // sqrt(35 / (32 pi))
  basis[10] = Real(1.44530572132027702715) * s2 * z;  // sqrt(105 / (16 pi))
  basis[11] = Real(0.45704579946446573616) * y * (Real(5.0) * z2 - Real(1.0));  // sqrt(21 / (32 pi))
  basis[12] = Real(0.37317633259011539141) * z * (Real(5.0) * z2 - Real(3.0));  // sqrt(7 / (16 pi))
  basis[13] = Real(0.45704579946446573616) * x * (Real(5.0) * z2 - Real(1.0));
  basis[14] = Real(1.44530572132027702715) * c2 * z;
  basis[15] = Real(0.59004358992664351035) * c3;
  basis[16] = Real(0.62583573544917613459) * s4;   // 3/16 sqrt(35 / pi)
  basis[17] = Real(1.77013076977993053105) * s3 * z;  // 3/4 sqrt(35 / (2 pi))
  basis[18] = Real(0.47308734787878000905) * s2 * (Real(7.0) * z2 - Real(1.0));  // 3/8 sqrt(5 / pi)
  basis[19] = Real(0.66904654355728916795) * y * z * (Real(7.0) * z2 - Real(3.0));  // 3/4 sqrt(5 / (2 pi))
  basis[20] = Real(0.10578554691520430380) * (z2 * (Real(35.0) * z2 - Real(30.0)) + Real(3.0));  // 3/16 sqrt(1 / pi)
  basis[21] = Real(0.66904654355728916795) * x * z * (Real(7.0) * z2 - Real(3.0));
  basis[22] = Real(0.47308734787878000905) * c2 * (Real(7.0) * z2 - Real(1.0));
  basis[23] = Real(1.77013076977993053105) * c3 * z;
  basis[24] = Real(0.62583573544917613459) * c4;
}

// Clamped-cosine coefficients A_l = 2 pi times the integral of max(t, 0) P_l(t): irradiance_lm = A_l radiance_lm (Ramamoorthi and Hanrahan 2001).
// pi, 2 pi/3, pi/4, 0, -pi/24 for l = 0..4. NaN for other l.
FN Real shClampedCosine(IN(int) l) {
  if (l == 0) return kPi;
  if (l == 1) return Real(2.0 / 3.0) * kPi;
  if (l == 2) return Real(0.25) * kPi;
  if (l == 3) return Real(0.0);
  if (l == 4) return -Real(1.0 / 24.0) * kPi;
  return notANumber();
}

// Convolution with a zonal kernel of coefficients g_l scales band l by this times g_l: sqrt(4 pi / (2 l + 1)).
FN Real shConvolutionScale(IN(int) l) { return sqrt(kFourPi / Real(2 * l + 1)); }

// Weight of one of `sampleCount` uniformly spread directions in a projection: c_lm = weight * sum of f(w_i) Y_lm(w_i).
FN Real shProjectionWeight(IN(int) sampleCount) { return kFourPi / Real(sampleCount); }
