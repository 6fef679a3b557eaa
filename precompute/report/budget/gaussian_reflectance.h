#pragma once
/// The reflectance with its distribution of half vectors as Gaussians there: the paper's fit, without its warp to light directions.

#include "precompute/reference/brdf.h"

namespace chiaro {

/// What the reflection (not the diffuse part, not a coat) is to be multiplied by at a half vector: GGX's mixture of four Gaussians over the distribution, where the
/// renderer draws lobes; towards 1 where it passes over to the reflectance itself (roughReflectionShare). 1 for anisotropic surfaces and the other models: one Gaussian
/// is all that their distributions have. Tangent frame, unit.
double gaussianOverExact(const reference::Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

}  // namespace chiaro
