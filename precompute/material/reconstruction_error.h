#pragma once
/// Equation (11) of Wang et al. 2009's supplement, with data as the truth.

#include <functional>
#include <vector>

#include "precompute/material/fit_samples.h"
#include "precompute/material/material_fit.h"
#include "precompute/material/ndf_mixture.h"

namespace chiaro {

/// Sum of (rho - rho^R)^2 ((n.wi) (n.wo))^2 by that of rho alone, of luminances, over the samples, weighted by their solid angles.
double reconstructionError(const std::vector<FitSample>& samples, const ReflectanceFunction& reconstruction);

/// How the lobes of a distribution become lobes of light.
enum class LobeWarp {
  none,       ///< they are looked up at the half vector: the error of the mixture alone
  isotropic,  ///< one round lobe each, the paper's
  chosen,     ///< by warp_choice.glsl, round lobes only
};

/// A fitted material with the mixture in place of its distribution; smooth factor, Fresnel and the diffuse part stay as they are. The family is
/// one of modelFamily. `mixture`: of the distribution with peak 1.
ReflectanceFunction mixtureReflectance(int kind, const MaterialFit& fit, const NdfMixture& mixture, LobeWarp warp);

/// The distribution of a fit's lobes by angle, peak 1 at the normal, as ndf.glsl has it.
std::function<double(double)> fittedNdf(int kind, double width);

}  // namespace chiaro
