#pragma once
/// The reflectance with its distribution of half vectors as the Gaussians that the renderer's lobes are made from: the fit without the warp.

#include "precompute/reference/brdf.h"

namespace chiaro {

/// What the reflection (not the diffuse part, not a coat) is to be multiplied by at a half vector: the mixture of four Gaussians over the distribution, where the
/// renderer draws lobes; towards 1 where it passes over to the reflectance itself (roughReflectionShare). 1 for anisotropic surfaces and for models whose lobes are
/// fitted to whole slices: there is no mixture to tell from the warp. Tangent frame, unit.
double gaussianOverExact(const reference::Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

}  // namespace chiaro
