#pragma once
/// What a reflectance looks like: spheres under an environment, by brute force.

#include <vector>

#include "assets/builtin/environment.h"
#include "precompute/material/measured_reflectance.h"

namespace chiaro {

struct SphereOptions {
  int size = 200;      ///< pixels a side, one sphere
  int samples = 192;   ///< directions a pixel of each of three kinds: towards the light, towards the reflection, of a cosine
  double width = 0.1;  ///< of the reflection that is sampled, as GGX
  int threads = 0;     ///< never changes the picture
};

/// One unit sphere for each reflectance, side by side, lit without shadows, seen from +Z without perspective. All take the same directions, so
/// that they differ by what they reflect and not by noise. Alpha is 1 on a sphere. A reflectance that is NaN or negative counts as 0.
ImageRgba spherePicture(const std::vector<ReflectanceFunction>& reflectances, const Environment& environment,
                        const SphereOptions& options);

}  // namespace chiaro
