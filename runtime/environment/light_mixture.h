#pragma once
/// The bright, compact parts of an environment as a few SG lights: a mixture of vMF lobes over a broad background, fitted to
/// luminance by expectation maximisation (ALGORITHMS 4.2; lobes from resultants by 1.8).

#include <vector>

#include "assets/image/image.h"
#include "runtime/environment/sg_environment.h"

namespace chiaro {

/// What stands out from its surroundings at one place, as EM needs it: exact sums over the texels it stands for.
struct ExcessPoint {
  glm::dvec3 resultant{
      0.0};               ///< sum of luminance excess * direction * solid angle; shorter than `flux` by the place's own extent
  double flux = 0.0;      ///< sum of luminance excess * solid angle
  glm::dvec3 color{0.0};  ///< the same in RGB
};

/// Luminance above a smooth lower envelope (what is left of the environment when everything compact is clipped off, blurred by
/// an SG of sharpness 8). Texels are gathered in blocks where they matter little: some thousands of points for any size.
std::vector<ExcessPoint> excessPoints(const ImageRgb& environment);

/// At most settings.lightCount lights with sharpness in [minLightSharpness, maxLightSharpness], brightest first. A light's RGB flux is
/// that of the excess assigned to it; lights under 0.2 % of the environment's flux are left out. Deterministic.
std::vector<SgLight> fitLights(const ImageRgb& environment, const SgEnvironmentSettings& settings);

}  // namespace chiaro
