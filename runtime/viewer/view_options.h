#pragma once
/// What chiaro-view was asked to do.

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "assets/image/display.h"
#include "assets/scene/camera_spec.h"
#include "assets/scene/material_override.h"
#include "assets/scene/vertex_cache.h"
#include "runtime/render/renderer.h"
#include "runtime/viewer/animation.h"

namespace CLI {
class App;
}

namespace chiaro {

enum class ViewMode {
  interactive,  ///< a window, until it is closed
  window,       ///< a window that draws a number of frames, saves them and closes
  headless      ///< the same without a window
};

struct ViewOptions {
  std::filesystem::path scene;            ///< a baked .glb
  std::vector<std::string> environments;  ///< names or files; never empty after finishViewOptions()
  ViewMode mode = ViewMode::interactive;
  glm::ivec2 size{1280, 720};             ///< pixels
  CameraSpec camera;
  glm::vec2 orbit{0.0f};                  ///< radians
  double rotateEnvironmentDegrees = 0.0;  ///< about +Y, counter-clockwise seen from above
  std::optional<float> exposure;          ///< absent: autoExposure() of the environment
  ToneMap toneMap = ToneMap::neutral;
  int supersample = 1;
  MaterialOverride materials;
  std::vector<Light> lights;              ///< beside the scene's own
  bool shadows = true;
  bool background = true;
  bool energyCompensation = false;
  int lobes = 0;                          ///< RenderSettings::lobes
  int prefilter = 512;                    ///< SgEnvironmentSettings::finestResolution
  DebugView debugView = DebugView::none;
  int upsample = 1;
  UpsampleWeights upsampleWeights = UpsampleWeights::lobe;
  RecomputeBudget recompute;
  Animation animation = Animation::none;
  VertexCacheFiles shapes;                ///< a mesh that changes shape
  std::string moving;                     ///< a mesh that turns; empty: none
  double startSeconds = 0.0;              ///< of the animation
  int frames = 1;
  int threads = 0;
  std::filesystem::path picture;          ///< .png or .exr; empty: none
  std::filesystem::path timings;          ///< JSON; empty: none
  bool quiet = false;
};

/// The option values as text, before finishViewOptions() turns them into the above.
struct ViewOptionTexts {
  std::string size = "1280x720";
  std::string camera = "auto";
  std::string orbit = "0,0";
  std::string exposure = "auto";
  std::string toneMap = "neutral";
  std::string debugView = "none";
  std::string upsampleWeights = "lobe", recompute = "10%";
  std::string picture;
  std::string timings;
  std::string scene;
  std::optional<float> roughness, metallic;
  std::string model;
  std::string animate = "none";
  std::vector<std::string> lights;
  bool headless = false, window = false, noShadows = false, noBackground = false, framesGiven = false;
};

/// Declares every option on `app`; the two structures must outlive its parse().
void declareViewOptions(CLI::App& app, ViewOptions& options, ViewOptionTexts& texts);

/// Checks and converts what parse() left. Touches no file but to see that the outputs could be written and the environments
/// exist. Throws Error (usage, unreadableInput, unwritableOutput).
void finishViewOptions(ViewOptions& options, const ViewOptionTexts& texts);

/// "1280x720": each side 1..16384. Throws Error (usage).
glm::ivec2 parseSize(const std::string& text);
/// Names of DebugView, in its order.
const std::vector<std::string>& debugViewNames();
/// Throws Error (usage).
DebugView debugViewFromName(const std::string& name);
enum class PictureFormat { png, exr };
/// By the name's extension (case ignored). Throws Error (usage) for any other.
PictureFormat pictureFormat(const std::filesystem::path& path, const std::string& option);

/// A rotation about +Y. Whole turns are taken out before anything is rounded, so 360 is exactly 0.
glm::mat3 environmentRotation(double degrees);

}  // namespace chiaro
