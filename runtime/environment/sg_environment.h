#pragma once
/// An environment as the runtime lights with it: a pyramid of SG-prefiltered radiance and a few SG lights (Wang et al. 2009,
/// section 5; ALGORITHMS 4.1, 4.2).

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "assets/builtin/environment.h"

namespace chiaro {

/// radiance(w) = amplitude * exp(sharpness * (dot(axis, w) - 1))
struct SgLight {
  glm::vec3 axis{0, 0, 1};
  float sharpness = 0.0f;
  glm::vec3 amplitude{0.0f};
};

/// One prefiltered sphere: mean radiance under a normalised SG of this sharpness about each texel's direction.
struct PrefilteredLevel {
  float sharpness = 0.0f;
  int faceResolution = 0;
  std::vector<glm::vec3> texels;  ///< 6 faces (+X -X +Y -Y +Z -Z, GL orientation) by faceResolution^2, row-major
};

/// As two cube maps with mip chains, made for one GL cube-map array with two layers: mip m of layer 0 has sharpness
/// finestSharpness / 4^m, layer 1 half of that; face resolution halves with each mip. (Sharpness ratio 2 between neighbours:
/// 4 % kernel error when interpolated in log2 sharpness; resolution about 6 sqrt(sharpness).)
struct SgPyramid {
  float finestSharpness = 0.0f;
  int finestResolution = 0;
  std::vector<PrefilteredLevel> layer0;
  std::vector<PrefilteredLevel> layer1;
};

struct SgEnvironmentSettings {
  int lightCount = 12;              ///< at most; fewer when the environment has fewer bright spots
  float minLightSharpness = 20.0f;  ///< broader light stays in the residual
  float maxLightSharpness = 1e6f;
  int finestResolution = 512;  ///< power of two; the finest sharpness is finestResolution^2 / 32 (8192)
  int threads = 0;
};

struct SgEnvironment {
  ImageRgb radiance;            ///< the equirectangular map itself: the background, and lobes sharper than the pyramid
  std::vector<SgLight> lights;  ///< brightest first (by flux)
  /// Of the whole environment, lights included. A shader that treats the lights apart subtracts their exact convolution
  /// (ALGORITHMS 1.4) where it needs the rest alone.
  SgPyramid pyramid;
};

/// Throws Error (usage) unless SgEnvironmentSettings::finestResolution may be this. `where` names the setting.
void requireFinestResolution(int resolution, const std::string& where);

/// Deterministic for any thread count. A constant environment gives that constant at every texel and no light.
/// Throws Error: unreadableInput for an empty image or one with negative, infinite or undefined texels; usage for settings
/// out of range (finestResolution: a power of two, 16..1024).
SgEnvironment prepareEnvironment(const Environment& environment, const SgEnvironmentSettings& settings = {});

/// How sharp the unfiltered map of this width is: a texel spread by linear interpolation has variance step^2/6 along each axis,
/// so 6 (width / 2 pi)^2. A lobe sharper than the pyramid's finest level goes, linearly in log2 sharpness, from that level
/// to the map itself, reached here; samplePyramid() stays at the finest level.
float unfilteredSharpness(int equirectangularWidth);

/// Trilinear-in-spirit lookup as the shader does it (bilinear in a face, linear in log2 sharpness): for tests and tools.
glm::vec3 samplePyramid(const SgPyramid& pyramid, glm::vec3 direction, float sharpness);

}  // namespace chiaro
