#pragma once
/// Upsampled frames beside shading every pixel, over a path of camera and object: what the filter alone costs and spoils.

#include <glm/glm.hpp>
#include <functional>
#include <string>
#include <vector>

#include "assets/image/image.h"
#include "assets/scene/camera_spec.h"
#include "assets/scene/vertex_cache.h"
#include "assets/transfer/transfer.h"
#include "runtime/render/render_settings.h"

namespace chiaro {

/// One reflectance for every material of the scene, all metal; a width or an exponent.
struct StudyMaterial {
  Reflectance model = Reflectance::ggx;
  float parameter = 0.1f;

  std::string name() const;
};

/// Blinn-Phong exponents 5, 50, 255, 1023 and GGX alpha .02, .05, .1, .2, .4, .6.
std::vector<StudyMaterial> standardMaterials();

struct StudyVariant {
  std::string name;
  UpsampleWeights weights = UpsampleWeights::lobe;
  bool estimate = true;    ///< RenderSettings::upsampleEstimate
  bool recomputes = false; ///< UpsamplingSettings::recompute of the pixels at most
};

/// Lobe weights with what belongs to them, the two baselines, and both weights with recomputation.
std::vector<StudyVariant> standardVariants();
/// Those and what tells the weights and the estimate apart: lobe_plain, normal_estimated, bilinear_estimated, normal_estimated_recomputed.
std::vector<StudyVariant> allVariants();

struct UpsamplingSettings {
  std::vector<StudyMaterial> materials;
  std::vector<StudyVariant> variants;
  std::string environment = "sunny";
  CameraSpec camera;
  glm::ivec2 size{480, 270};
  int upsample = 4;
  int frames = 60;
  float turnDegrees = 0.5f;    ///< of the camera about what it looks at, a frame
  std::string moving;          ///< a mesh that turns about +Y through its middle; empty: none
  float movingDegrees = 1.0f;  ///< a frame
  VertexCacheFiles shapes;     ///< a frame of it each frame
  float recompute = 0.1f;
  int warmUp = 16;             ///< frames before the first that counts: each pixel of a cell of 4 x 4 is shaded once
  int threads = 0;
};

/// FLIP is slow: some eight frames of a run have it.
int flipEvery(const UpsamplingSettings& settings);

/// All of tone-mapped, sRGB-encoded channels in [0,1] over the pixels that the full frame covers, all frames together.
struct VariantResult {
  StudyVariant variant;
  double rmse = 0.0, psnr = 0.0;
  double wholePsnr = 0.0;    ///< over all pixels, background too
  double lowestPsnr = 0.0;   ///< of any frame
  double flip = 0.0;         ///< mean over every flipEvery()-th frame
  double flicker = 0.0;      ///< mean |change from frame to frame| less the full frames' own
  double changeError = 0.0;  ///< mean |change from frame to frame minus the full frames' change|
  double recomputed = 0.0;   ///< share of all pixels
  double recomputedOfObjects = 0.0;  ///< share of those that objects cover
  double milliseconds = 0.0; ///< median GPU time of a frame
  double filterMilliseconds = 0.0;
};

struct MaterialResult {
  StudyMaterial material;
  double fullMilliseconds = 0.0;
  std::vector<VariantResult> variants;
};

/// A picture of the last frame of a variant ("full" is the full one), or of its total weights.
using StudyPicture = std::function<void(const std::string& material, const std::string& variant, const Image8&)>;
using StudyProgress = std::function<void(const std::string& stage, double done)>;

/// Needs a current OpenGL context. Throws Error.
std::vector<MaterialResult> studyUpsampling(const BakedScene& baked, const UpsamplingSettings& settings, const StudyPicture& picture,
                                            const StudyProgress& progress);

}  // namespace chiaro
