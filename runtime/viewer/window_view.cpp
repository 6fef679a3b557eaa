#include "runtime/viewer/window_view.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <future>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include "assets/builtin/environment.h"
#include "assets/error.h"
#include "assets/scene/camera_spec.h"
#include "assets/scene/light_spec.h"
#include "runtime/viewer/orbit_camera.h"
#include "runtime/viewer/panel.h"
#include "runtime/viewer/preview.h"
#include "runtime/viewer/view_inputs.h"
#include "runtime/viewer/view_run.h"
#include "runtime/viewer/window.h"

namespace chiaro {
namespace {

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0f;
constexpr float kKeyStep = 5.0f * kDegrees;
constexpr double kRestSeconds = 0.2;                     // without a change, before a slow driver draws the whole picture
constexpr int kSettlingFrames = 32;  // twice the points of the largest cell
constexpr float kDragTurn = std::numbers::pi_v<float>;  // a drag over the window's height is half a turn

std::string titleOf(const std::filesystem::path& path) { return path.filename().string() + " - Chiaro"; }

std::string sceneLine(const LoadedScene& loaded) {
  const Scene& scene = loaded.baked.scene;
  char text[160];
  std::snprintf(text, sizeof text, "%zu vertices, %zu triangles, %.1f MB, %.0f bytes of transfer a vertex", scene.vertexCount(),
                scene.triangleCount(), 1e-6 * static_cast<double>(loaded.fileBytes),
                loaded.baked.transfer.bytesPerVertex(scene.vertexCount(), loaded.baked.coded ? &*loaded.baked.coded : nullptr));
  return text;
}

PanelState panelFor(const ViewOptions& options, const LoadedScene& loaded) {
  PanelState state;
  state.rotationDegrees = static_cast<float>(std::remainder(options.rotateEnvironmentDegrees, 360.0));
  state.autoExposure = !options.exposure.has_value();
  state.exposureStops = options.exposure ? std::log2(*options.exposure) : 0.0f;
  state.toneMap = options.toneMap;
  state.shadows = options.shadows;
  state.background = options.background;
  state.supersample = options.supersample;
  state.upsample = options.upsample;
  state.upsampleWeights = options.upsampleWeights;
  state.recompute = options.recompute;
  state.debugView = options.debugView;
  state.environments = options.environments;
  for (const auto& name : builtinEnvironmentNames())
    if (std::find(state.environments.begin(), state.environments.end(), name) == state.environments.end()) state.environments.push_back(name);
  const GlFacts facts = glFacts("window");
  state.driverLine = facts.renderer + ", OpenGL " + facts.version;
  state.materials = loaded.baked.scene.materials;
  state.lights = loaded.baked.scene.lights;
  state.sceneSize = boundsOf(loaded.baked.scene).diagonal();
  state.sceneLine = sceneLine(loaded);
  for (const auto& camera : loaded.baked.scene.cameras) state.cameras.push_back(camera.name);
  return state;
}

/// Everything a frame depends on but the camera and the uploads.
bool same(const RenderSettings& a, const RenderSettings& b) {
  return a.width == b.width && a.height == b.height && a.supersample == b.supersample && a.worldFromEnvironment == b.worldFromEnvironment &&
         a.exposure == b.exposure && a.toneMap == b.toneMap && a.shadows == b.shadows && a.background == b.background &&
         a.debugView == b.debugView && a.upsample == b.upsample && a.upsampleWeights == b.upsampleWeights &&
         a.recompute.share == b.recompute.share && a.recompute.milliseconds == b.recompute.milliseconds;
}

bool same(const Camera& a, const Camera& b) {
  return a.worldFromCamera == b.worldFromCamera && a.perspective == b.perspective && a.verticalFov == b.verticalFov &&
         a.verticalExtent == b.verticalExtent && a.nearPlane == b.nearPlane && a.farPlane == b.farPlane;
}

template <class T>
bool ready(const std::future<T>& pending) {
  return pending.valid() && pending.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

class InteractiveView {
 public:
  explicit InteractiveView(const ViewOptions& options)
      : options_(options),
        loaded_(loadForView(options.scene, options.materials, options.lights)),
        orbit_(viewCamera(options, loaded_.baked.scene), boundsOf(loaded_.baked.scene)),
        window_(options.size, titleOf(options.scene)),
        renderer_(std::make_unique<Renderer>(loaded_.baked)),
        state_(panelFor(options, loaded_)),
        animator_(loaded_.baked.scene, options.animation, options.moving, options.shapes) {
    if (!options.quiet) warnOfLeftOut(loaded_);
    choose(0);
  }

  void run() {
    int unsettled = 3;  // Dear ImGui needs a few frames until its layout rests
    while (!window_.closing()) {
      const bool moving = state_.continuous || animator_.moves();
      const bool awaiting = pendingEnvironment_.valid() || pendingScene_.valid() || coarse_;
      window_.pollEvents(unsettled > 0 || moving || settling() ? 0.0 : awaiting ? 0.05 : 0.5);
      if (collectPending() || window_.takeActivity()) unsettled = 3;
      for (const auto& path : window_.takeDroppedFiles()) open(path);
      const glm::ivec2 size = window_.framebufferSize();
      if (size.x <= 0 || size.y <= 0) {
        window_.pollEvents(0.1);
        continue;
      }
      if (unsettled == 0 && !moving && !coarse_ && !settling()) continue;
      drawFrame(size);
      if (unsettled > 0) --unsettled;
    }
  }

 private:
  void drawFrame(glm::ivec2 size) {
    state_.verticalFovDegrees = orbit_.camera().verticalFov / kDegrees;
    state_.busyLine = pendingEnvironment_.valid() ? "Preparing " + pendingName_ + " ..." : pendingScene_.valid() ? "Loading ..." : "";
    window_.beginPanel();
    navigate(static_cast<float>(size.x) / static_cast<float>(size.y));
    apply(drawPanel(state_), static_cast<float>(size.x) / static_cast<float>(size.y));
    window_.clear();
    if (environment_ != nullptr) {
      render(size);
      renderer_->present(size.x, size.y);
      if (saveWanted_ && (!settling() || animator_.moves())) {
        save();
        saveWanted_ = false;
      }
    }
    window_.endPanelAndSwap();
  }

  void navigate(float aspect) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto keys = window_.takeKeys();
    if (!io.WantCaptureKeyboard) {
      for (const auto key : keys) press(key, aspect);
    }
    if (io.WantCaptureMouse || !(io.DisplaySize.y > 0.0f)) return;
    const glm::vec2 motion = glm::vec2(io.MouseDelta.x, io.MouseDelta.y) / io.DisplaySize.y;
    if (motion != glm::vec2(0.0f)) {
      if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) orbit_.orbit(-kDragTurn * motion.x, kDragTurn * motion.y);
      else if (ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle)) orbit_.pan(motion.x, -motion.y);
    }
    if (io.MouseWheel != 0.0f) orbit_.dolly(io.MouseWheel);
  }

  void press(Window::Key key, float aspect) {
    switch (key) {
      case Window::Key::frame: orbit_.frame(aspect); break;
      case Window::Key::left: orbit_.orbit(-kKeyStep, 0.0f); break;
      case Window::Key::right: orbit_.orbit(kKeyStep, 0.0f); break;
      case Window::Key::up: orbit_.orbit(0.0f, kKeyStep); break;
      case Window::Key::down: orbit_.orbit(0.0f, -kKeyStep); break;
    }
  }

  void apply(const PanelActions& actions, float aspect) {
    const auto& cameras = loaded_.baked.scene.cameras;
    if (actions.environment) choose(*actions.environment);
    if (actions.camera && *actions.camera < cameras.size()) orbit_ = OrbitCamera(cameras[*actions.camera], boundsOf(loaded_.baked.scene));
    if (actions.fovChanged) orbit_.setVerticalFov(state_.verticalFovDegrees * kDegrees);
    if (actions.frameScene) orbit_.frame(aspect);
    if (actions.copyCamera) {
      const std::string spec = lookAtSpec(glm::vec3(orbit_.camera().worldFromCamera[3]), orbit_.target(), orbit_.camera().verticalFov);
      window_.copyToClipboard("--camera " + spec);
      say("copied --camera " + spec);
    }
    if (actions.resetMaterials) state_.materials = loaded_.baked.scene.materials;
    if (actions.materialsChanged || actions.resetMaterials) {
      renderer_->setMaterials(state_.materials);
      stale_ = true;
    }
    if (actions.lightsChanged) {
      renderer_->setLights(state_.lights);
      stale_ = true;
    }
    if (actions.copyLights) {
      std::string text;
      for (const auto& light : state_.lights) text += (text.empty() ? "--light " : " --light ") + lightSpec(light);
      window_.copyToClipboard(text);
      say("copied " + text);
    }
    if (actions.savePicture) saveWanted_ = true;
  }

  RenderSettings wantedSettings(glm::ivec2 size) const {
    RenderSettings settings;
    settings.width = size.x;
    settings.height = size.y;
    settings.supersample = state_.supersample;
    settings.worldFromEnvironment = environmentRotation(static_cast<double>(state_.rotationDegrees));
    settings.exposure = exposureFactor(state_, environment_->exposure);
    settings.toneMap = state_.toneMap;
    settings.shadows = state_.shadows;
    settings.background = state_.background;
    settings.energyCompensation = options_.energyCompensation;
    settings.lobes = options_.lobes;
    settings.debugView = state_.debugView;
    settings.upsample = state_.upsample;
    settings.upsampleWeights = state_.upsampleWeights;
    settings.recompute = state_.recompute;
    return settings;
  }

  /// Draws what has changed: coarsely while it goes on changing where the driver is slow, and whole when it rests. A picture
  /// at rest costs nothing: what was drawn last is shown again, once upsampling has shaded every pixel.
  void render(glm::ivec2 size) {
    const RenderSettings wanted = wantedSettings(size);
    if (animator_.moves()) {
      animator_.apply(*renderer_, options_.startSeconds + secondsNow() - startedAt_);
      stale_ = true;
    }
    const bool changed = stale_ || !same(wanted, wanted_) || !same(orbit_.camera(), drawnFrom_);
    const bool whole = state_.continuous || saveWanted_;
    if (changed) changedAt_ = secondsNow();
    const bool rested = secondsNow() - changedAt_ > kRestSeconds;
    const bool previewEnds = coarse_ && (rested || whole);
    if (changed || previewEnds) settledFrames_ = 0;
    if (!state_.continuous && !changed && !settling() && !previewEnds) return;
    ++settledFrames_;

    const RenderSettings settings = changed && !whole ? previewSettings(wanted, millisecondsPerSample_) : wanted;
    renderer_->render(orbit_.camera(), settings);
    state_.passes = renderer_->timings().passes;
    if (!state_.passes.empty()) {
      state_.history.add(static_cast<float>(state_.passes.back().second));
      millisecondsPerSample_ = state_.passes.back().second / sampleCount(settings);
    }
    wanted_ = wanted;
    drawnFrom_ = orbit_.camera();
    coarse_ = !same(settings, wanted);
    stale_ = false;
  }

  /// Upsampling has not shaded every pixel of what is shown. A preview settles when it has given way to the whole picture.
  bool settling() const { return environment_ != nullptr && state_.upsample > 1 && !coarse_ && settledFrames_ < kSettlingFrames; }

  void save() {
    guarded([&] {
      savePicture(*renderer_, state_.pictureName.data());
      say(std::string("wrote ") + state_.pictureName.data());
    });
  }

  void open(const std::filesystem::path& path) {
    switch (droppedKind(path)) {
      case DroppedKind::environment: {
        auto& names = state_.environments;
        auto found = std::find(names.begin(), names.end(), path.string());
        if (found == names.end()) found = names.insert(names.end(), path.string());
        choose(static_cast<std::size_t>(found - names.begin()));
        break;
      }
      case DroppedKind::scene:
        if (pendingScene_.valid()) complain(path.string() + ": another scene is being loaded: drop it again when it is there");
        else pendingScene_ = std::async(std::launch::async, loadForView, path, options_.materials, options_.lights);
        break;
      case DroppedKind::other:
        complain(path.string() + ": neither an environment nor a baked scene: drop an .hdr, .exr or .glb");
        break;
    }
  }

  /// At once when it was prepared before, else in the background.
  void choose(std::size_t index) {
    const std::string& name = state_.environments[index];
    if (const auto known = prepared_.find(name); known != prepared_.end()) {
      use(known->second);
    } else if (pendingEnvironment_.valid()) {
      complain(name + ": " + pendingName_ + " is being prepared: choose again when it is there");
    } else {
      pendingName_ = name;
      pendingEnvironment_ = std::async(std::launch::async, prepareForView, name, options_.prefilter, options_.threads);
    }
  }

  void use(std::shared_ptr<const PreparedEnvironment> environment) {
    environment_ = std::move(environment);
    renderer_->setEnvironment(environment_->light);
    const auto& names = state_.environments;
    state_.environment = static_cast<std::size_t>(std::find(names.begin(), names.end(), environment_->name) - names.begin());
    stale_ = true;
  }

  void use(LoadedScene loaded) {
    auto renderer = std::make_unique<Renderer>(loaded.baked);  // may throw: the old scene then stays
    if (environment_ != nullptr) renderer->setEnvironment(environment_->light);
    renderer_ = std::move(renderer);
    loaded_ = std::move(loaded);
    // What was asked for is of the scene that was given.
    const bool own = options_.animation == Animation::scene && loaded_.baked.scene.motions.empty();
    animator_ = Animator(loaded_.baked.scene, own ? Animation::none : options_.animation, "");
    const glm::ivec2 size = glm::max(window_.framebufferSize(), glm::ivec2(1));
    orbit_ = OrbitCamera(defaultCamera(loaded_.baked.scene, static_cast<float>(size.x) / static_cast<float>(size.y)), boundsOf(loaded_.baked.scene));
    state_.materials = loaded_.baked.scene.materials;
    state_.lights = loaded_.baked.scene.lights;
    state_.sceneSize = boundsOf(loaded_.baked.scene).diagonal();
    state_.cameras.clear();
    for (const auto& camera : loaded_.baked.scene.cameras) state_.cameras.push_back(camera.name);
    state_.sceneLine = sceneLine(loaded_);
    window_.setTitle(titleOf(loaded_.path));
    stale_ = true;
  }

  bool collectPending() {
    bool any = false;
    if (ready(pendingEnvironment_)) {
      any = true;
      const auto take = [&] {
        const auto environment = std::make_shared<const PreparedEnvironment>(pendingEnvironment_.get());
        prepared_[environment->name] = environment;
        use(environment);
      };
      // Without the first there is nothing to show: that is the program's failure.
      if (environment_ == nullptr) take();
      else guarded(take);
    }
    if (ready(pendingScene_)) {
      any = true;
      guarded([&] {
        use(pendingScene_.get());
        say(leftOut(loaded_.baked.scene));
      });
    }
    return any;
  }

  template <class Action>
  void guarded(Action action) {
    try {
      action();
    } catch (const std::exception& error) {
      complain(error.what());
    }
  }

  void say(std::string text) {
    state_.message = std::move(text);
    state_.messageIsError = false;
  }
  void complain(std::string text) {
    state_.message = std::move(text);
    state_.messageIsError = true;
  }

  const ViewOptions options_;
  LoadedScene loaded_;
  OrbitCamera orbit_;
  std::shared_ptr<const PreparedEnvironment> environment_;
  std::map<std::string, std::shared_ptr<const PreparedEnvironment>> prepared_;
  Window window_;
  std::unique_ptr<Renderer> renderer_;
  PanelState state_;
  std::future<PreparedEnvironment> pendingEnvironment_;
  std::string pendingName_;
  std::future<LoadedScene> pendingScene_;
  RenderSettings wanted_;     // of the last frame, before any coarsening
  Camera drawnFrom_;
  bool stale_ = true;         // materials, environment or scene are not those of the last frame
  bool coarse_ = false;       // the last frame was a preview
  int settledFrames_ = 0;  // drawn since anything changed
  double changedAt_ = 0.0;
  const double startedAt_ = secondsNow();  // of an animation
  Animator animator_;
  double millisecondsPerSample_ = std::numeric_limits<double>::infinity();
  bool saveWanted_ = false;
};

}  // namespace

void viewInteractive(const ViewOptions& options) { InteractiveView(options).run(); }

void viewInWindow(const ViewOptions& options) {
  const LoadedScene scene = loadForView(options.scene, options.materials, options.lights);
  const Camera camera = viewCamera(options, scene.baked.scene);
  Window window(options.size, titleOf(options.scene));
  const PreparedEnvironment environment = prepareForView(options.environments.front(), options.prefilter, options.threads);
  PanelState state = panelFor(options, scene);
  runFrames(options, scene, camera, environment, glFacts("window"), window.debugLog(), [&](Renderer& renderer, int) {
    window.pollEvents();
    if (window.closing()) throw Error(ExitCode::interrupted, "window", "closed before the last frame", "");
    const glm::ivec2 size = window.framebufferSize();
    if (size.x <= 0 || size.y <= 0) return;
    state.passes = renderer.timings().passes;
    if (!state.passes.empty()) state.history.add(static_cast<float>(state.passes.back().second));
    renderer.present(size.x, size.y);
    window.beginPanel();
    drawPanel(state);
    window.endPanelAndSwap();
  });
}

}  // namespace chiaro
