#pragma once
/// The window's panel: what it shows, what it lets the user change, and what it was asked to do.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assets/image/display.h"
#include "assets/scene/scene.h"
#include "runtime/render/renderer.h"

namespace chiaro {

/// The last frames' times in milliseconds, oldest first.
class FrameHistory {
 public:
  void add(float milliseconds);
  const std::vector<float>& values() const { return values_; }
  float latest() const { return values_.empty() ? 0.0f : values_.back(); }

 private:
  static constexpr std::size_t kLength = 120;
  std::vector<float> values_;
};

/// Edited in place by drawPanel().
struct PanelState {
  // light
  std::vector<std::string> environments;  ///< names to choose from
  std::size_t environment = 0;            ///< the one that lights the scene now
  float rotationDegrees = 0.0f;
  // picture
  bool autoExposure = true;
  float exposureStops = 0.0f;             ///< on top of the automatic exposure, or of 1
  ToneMap toneMap = ToneMap::neutral;
  bool shadows = true;
  bool background = true;
  int supersample = 1;
  DebugView debugView = DebugView::none;
  int upsample = 1;
  UpsampleWeights upsampleWeights = UpsampleWeights::lobe;
  RecomputeBudget recompute;
  bool continuous = false;                ///< draw all the time, to watch the frame time
  // scene
  std::vector<Material> materials;
  std::vector<Light> lights;              ///< the file's and those of the command line
  float sceneSize = 1.0f;                 ///< metres, for how fast a dragged light moves
  std::vector<std::string> cameras;       ///< of the file
  float verticalFovDegrees = 40.0f;
  // files
  std::array<char, 512> pictureName{"chiaro.png"};
  // shown only
  std::string sceneLine, driverLine, busyLine, message;
  bool messageIsError = false;
  FrameHistory history;
  std::vector<std::pair<std::string, double>> passes;
};

/// What the user did this time that is more than a changed value.
struct PanelActions {
  std::optional<std::size_t> environment;  ///< chosen, of PanelState::environments
  std::optional<std::size_t> camera;       ///< chosen, of PanelState::cameras
  bool materialsChanged = false;
  bool resetMaterials = false;
  bool lightsChanged = false;
  bool copyLights = false;
  bool fovChanged = false;
  bool frameScene = false;
  bool copyCamera = false;
  bool savePicture = false;
};

/// Between Window::beginPanel() and endPanelAndSwap().
PanelActions drawPanel(PanelState& state);

/// exposureStops as a factor.
float exposureFactor(const PanelState& state, float autoExposure);

}  // namespace chiaro
