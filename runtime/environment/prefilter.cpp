#include "runtime/environment/prefilter.h"

#include <algorithm>

#include "runtime/environment/cube_map.h"
#include "runtime/parallel.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr int kCoarsestResolution = 4;

PrefilteredLevel resampleToCube(const SphereGrid& grid, float sharpness, int resolution, int threads) {
  PrefilteredLevel level;
  level.sharpness = sharpness;
  level.faceResolution = resolution;
  level.texels.resize(static_cast<std::size_t>(6) * static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution));
  parallelFor(6 * resolution, threads, [&](int line) {
    glm::vec3* texel = &level.texels[static_cast<std::size_t>(line) * static_cast<std::size_t>(resolution)];
    for (int column = 0; column < resolution; ++column) {
      const glm::vec2 uv =
          lobe32::equirectFromDirection(cubeTexelDirection(line / resolution, column, line % resolution, resolution));
      // The cut at the last band leaves a ripple of 1e-7 of the brightest value; radiance must not be negative for it.
      texel[column] = glm::max(grid.interpolate(uv.x, uv.y), glm::vec3(0.0f));
    }
  });
  return level;
}

PrefilteredLevel buildLevel(const SphereSpectrum& spectrum, float sharpness, int resolution, int threads) {
  const std::vector<double> factors = sgBandFactors(sharpness);
  // Twice the bands: the kernel is then 3.6 rows wide (one standard deviation), and cubic interpolation good to 4e-4 of a peak.
  const int bands = static_cast<int>(factors.size());
  const int rows = std::max(32, 2 * ((bands + 7) / 8) * 8);
  return resampleToCube(synthesise(spectrum, factors, rows, threads), sharpness, resolution, threads);
}

}  // namespace

float finestSharpnessOf(int finestResolution) {
  return static_cast<float>(finestResolution) * static_cast<float>(finestResolution) / 32.0f;
}

int bandsOf(int finestResolution) { return static_cast<int>(sgBandFactors(finestSharpnessOf(finestResolution)).size()); }

SgPyramid buildPyramid(const SphereSpectrum& spectrum, int finestResolution, int threads) {
  SgPyramid pyramid;
  pyramid.finestSharpness = finestSharpnessOf(finestResolution);
  pyramid.finestResolution = finestResolution;
  float sharpness = pyramid.finestSharpness;
  for (int resolution = finestResolution; resolution >= kCoarsestResolution; resolution /= 2, sharpness /= 4) {
    pyramid.layer0.push_back(buildLevel(spectrum, sharpness, resolution, threads));
    pyramid.layer1.push_back(buildLevel(spectrum, sharpness / 2, resolution, threads));
  }
  return pyramid;
}

}  // namespace chiaro
