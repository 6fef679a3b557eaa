#pragma once
/// The integral of light over the sphere at one surface point.

#include <cstdint>
#include <glm/glm.hpp>

#include "precompute/embree/ray_scene.h"
#include "precompute/reference/environment_sampler.h"
#include "precompute/reference/sampling.h"
#include "precompute/reference/surface.h"

namespace chiaro::reference {

/// Which densities to draw from; everything but `combined` is for tests of it.
enum class Strategy { combined, light, reflection, cosine };

struct Estimate {
  glm::dvec3 mean{0.0};  ///< radiance towards the viewer, W/(m^2 sr)
  glm::dvec3 varianceOfMean{0.0};
  std::uint64_t rays = 0;
};

/// `rays` null: nothing is shadowed. Light counts where it is above both the shading normal's and the interpolated normal's horizon and
/// its ray, started surfaceOffset() off the geometric surface, is free.
///
/// `samples` pairs of directions, one of each pair from the environment and one from the BRDF (reflection or cosine, at
/// random), each weighted by the balance heuristic over all three (Veach, 1997, eq. 9.8). They are drawn as 4 to 8 independently
/// randomised point sets of equal size (so `samples`, at least 2, is rounded up to a multiple of their number); the variance is
/// that between the sets.
Estimate environmentLight(const Surface& surface, glm::dvec3 wo, const EnvironmentSampler& environment, const RayScene* rays,
                          int samples, std::uint32_t seed, Strategy strategy = Strategy::combined);

/// The scene's lights. Those without a size are exact but for rounding; each of the others takes `samples` pairs as above.
Estimate lampLight(const Surface& surface, glm::dvec3 wo, const std::vector<Light>& lights, const RayScene* rays, int samples,
                   std::uint32_t seed, Strategy strategy = Strategy::combined);

}  // namespace chiaro::reference
