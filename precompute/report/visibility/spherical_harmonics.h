#pragma once
/// Real spherical harmonics of any band, and how an SG lobe weights them.

#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Bands 0 to bands - 1, index l (l + 1) + m: orthonormal, z the pole, no Condon-Shortley sign, as shaders/lobe/sh.glsl.
/// out: bands^2. By the three-term recurrence of normalised associated Legendre functions, stable upwards in l.
void evaluateSh(glm::dvec3 direction, int bands, double* out);

/// rho_l of a normalised SG lobe, l < bands: the lobe's mean of a function with coefficients c_lm is sum rho_l c_lm Y_lm(axis).
/// rho_l = I_{l+1/2}(sharpness) / I_{1/2}(sharpness), by the downward recurrence of their ratios. sharpness >= 0.
std::vector<double> lobeBands(double sharpness, int bands);

}  // namespace chiaro
