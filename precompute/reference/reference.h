#pragma once
/// The truth beside every picture: direct lighting by brute force, no spherical Gaussian and no SSDF in it.
///
///   Lo(x, wo) = integral over the sphere of f(wi, wo) max(n.wi, 0) V(x, wi) L(wi) dwi + emission + punctual lights
///
/// f is that of reference/brdf.h; V is traced with Embree.

#include <cstdint>

#include "assets/builtin/environment.h"
#include "assets/image/image.h"
#include "assets/scene/scene.h"
#include "precompute/bake.h"

namespace chiaro {

struct ReferenceSettings {
  int width = 640;
  int height = 480;
  int samplesPerPixel = 256;       ///< light/BRDF sample pairs a pixel (multiple importance sampling)
  int pixelGrid = 1;               ///< pixelGrid^2 primary rays at the centres of a grid over the pixel (1: pixel centre)
  glm::mat3 worldFromEnvironment{1.0f};
  bool shadows = true;             ///< false: V = 1 above the horizon
  bool energyCompensation = false; ///< GGX gives back what scatters more than once: reference/brdf.h
  bool background = true;          ///< false: black and coverage 0 where nothing is hit
  std::uint32_t seed = 0;
  int threads = 0;
};

struct ReferenceImage {
  ImageRgba radiance;              ///< linear; alpha = coverage
  ImageRgb varianceOfMean;         ///< per pixel and channel, of the Monte Carlo mean
  double noiseRms = 0.0;           ///< sqrt of the mean of the above over covered pixels
  std::uint64_t raysTraced = 0;
};

/// `scene` must have normals (prepareScene). Same picture for any thread count.
ReferenceImage renderReference(const Scene& scene, const Environment& environment, const Camera& camera,
                               const ReferenceSettings& settings, const ProgressHandler& progress = {});

}  // namespace chiaro
