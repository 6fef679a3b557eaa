#pragma once
/// The pyramid of SG-prefiltered radiance (ALGORITHMS 4.1).

#include "runtime/environment/sg_environment.h"
#include "runtime/environment/sphere_spectrum.h"

namespace chiaro {

/// Sharpness of the finest level for a face resolution: R = 5.7 sqrt(sharpness), a power of two.
float finestSharpnessOf(int finestResolution);

/// Bands that the finest level of this resolution keeps (the next one is below 1e-7).
int bandsOf(int finestResolution);

/// `spectrum` with bandsOf(finestResolution) bands. Mips go down to 4 texels a face.
SgPyramid buildPyramid(const SphereSpectrum& spectrum, int finestResolution, int threads);

}  // namespace chiaro
