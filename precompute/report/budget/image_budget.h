#pragma once
/// Which stage causes which part of a picture's error: the renderer's own shading with one stage after another exact, up to the truth.

#include <optional>
#include <string>
#include <vector>

#include "assets/scene/camera_spec.h"
#include "assets/scene/material_override.h"
#include "assets/transfer/transfer.h"
#include "precompute/bake.h"
#include "precompute/report/metrics.h"

namespace chiaro {

struct ImageBudgetSettings {
  std::string environment = "sunny";
  MaterialOverride materials;
  CameraSpec camera;
  glm::ivec2 size{96, 72};
  int samples = 512;      ///< of the reference and of exact light, pairs a pixel; even
  int raysPerLobe = 64;   ///< of every lobe whose visible share is asked for
  int upsample = 1;       ///< above 1: the picture is drawn so, and what that costs is the first cause
  std::uint32_t seed = 0;
  int threads = 0;
};

/// How far a picture is from the reference.
struct ImageError {
  double rmse = 0.0, psnr = 0.0;              ///< display-encoded
  double linearRmse = 0.0, linearPsnr = 0.0;  ///< radiance times exposure, peak 1, not clipped
  double flip = 0.0;                          ///< mean, display-encoded
};

/// The picture with more and more of its stages exact.
struct ImageStage {
  std::string what;      ///< what was made exact last
  std::string cause;     ///< of what the next stage does without; the last: what cannot be told from the truth
  ImageRgba picture;     ///< linear radiance, alpha coverage
  ImageError error;
  double change = 0.0;   ///< display-encoded RMSE between this picture and the next; the last: and the reference
};

struct ImageBudget {
  std::string glRenderer;
  Camera camera;
  DisplaySettings display;
  ImageRgba reference;             ///< pixels left out have coverage 0
  std::size_t pixels = 0;          ///< compared
  std::size_t leftOut = 0;         ///< covered pixels whose surface the renderer and the rays do not agree on (outlines), or that is blended
  ImageError referenceNoise;       ///< RMS of the reference's own noise; psnr and flip are not used
  ImageError exactNoise;           ///< the same of the last stage
  std::vector<ImageStage> stages;  ///< the first: as drawn; the last: everything exact, by other directions than the reference's

  /// RMSE of the last stage over what both noises explain: about 1 where the budget adds up.
  double leftOverNoise() const;
};

/// Draws under an environment alone (the scene's lights are left out), one point a pixel, and replaces stages one after another:
/// upsampling; visible shares, traced lobe by lobe; the prefiltered environment, integrated lobe by lobe; the product of both means, by the integral of light
/// times visibility (with it the fixed lobes of diffuse and rough light); lobes over light directions (warp and fit), by the distribution's Gaussians at half vectors; these, by
/// the exact reflectance; filtered textures, by the texels that rays meet. The renderer records what its pixels ask, answers are traced, and it draws again with them. Makes a headless OpenGL context. Same
/// figures for any number of threads. Throws Error.
ImageBudget imageBudget(const BakedScene& baked, const ImageBudgetSettings& settings, const ProgressHandler& progress);

}  // namespace chiaro
