#pragma once
/// Environments and independent answers for the tests of runtime/environment.

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/environment/sg_environment.h"

namespace chiaro::test {

/// Mean of `radiance(direction)` over samples^2 points of each texel.
Environment makeEnvironment(int width, int height, int samples, const std::function<glm::dvec3(const glm::dvec3&)>& radiance);
Environment constantEnvironment(int width, int height, glm::vec3 value);
/// Reproducible noise with a heavy tail: a few texels are 100 times brighter than the rest.
Environment noisyEnvironment(int width, int height, unsigned seed);
/// A uniform disc on a blue gradient sky; flux of the disc is `discFlux` white.
Environment discOnSky(int width, glm::dvec3 axis, double angularRadius, double discFlux);
/// A dark room with four bright rectangular windows.
Environment windowedRoom(int width);

/// Solid angle of a texel of this row.
double texelSolidAngle(const ImageRgb& map, int row);
/// Integral of radiance over the sphere.
glm::dvec3 fluxOf(const ImageRgb& map);
glm::dvec3 fluxOf(const SgLight& light);
/// Mean of bilinearly interpolated radiance under exp(sharpness (dot - 1)), by plain summation over subdivided texels.
glm::dvec3 sumUnderKernel(const ImageRgb& map, const glm::dvec3& direction, double sharpness, int subdivision);

/// The share of what varies at fine scale that the lights explain: 1 - |H(environment - lights)|^2 / |H environment|^2 over the
/// sphere, where H blurs by an SG of `sharpness` and takes away what a further blur of sharpness 32 leaves.
double explainedShare(const Environment& environment, const std::vector<SgLight>& lights, double sharpness);

const std::vector<PrefilteredLevel>& levelsOf(const SgPyramid& pyramid, int layer);

}  // namespace chiaro::test
