#pragma once
/// What a frame of a baked scene costs on this machine's OpenGL, and how far its picture is from brute force.

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "assets/scene/camera_spec.h"
#include "assets/transfer/transfer.h"
#include "precompute/bake.h"
#include "precompute/report/metrics.h"
#include "precompute/report/sweep/sweep_point.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/gl/context.h"
#include "runtime/render/renderer.h"

namespace chiaro {

struct SweepPictureSettings {
  std::string environment = "sunny";
  CameraSpec camera;
  glm::ivec2 size{320, 200};
  int samples = 64;  ///< of the reference, pairs a pixel
  int frames = 5;    ///< that are timed, after one that is not
  int threads = 0;
};

/// Draws with one point a pixel, without background.
class SweepPictures {
 public:
  /// Makes a headless OpenGL context. scene: prepared; must outlive it. Throws Error.
  SweepPictures(const Scene& scene, const SweepPictureSettings& settings);

  const std::string& glRenderer() const { return context_.renderer(); }
  /// What the figures depend on beside the scene and the point.
  std::string key() const;
  /// From here on of this bake.
  void open(const BakedScene& baked);
  /// frameMilliseconds and pictureRmse of `figures`, drawn with the point's lobes and prefilter. progress: of the reference, which is drawn once.
  void measure(const SweepPoint& point, SweepFigures& figures, const ProgressHandler& progress);

 private:
  const ReferenceHalves& reference(const ProgressHandler& progress);
  const SgEnvironment& prefiltered(int resolution);

  const Scene& scene_;
  SweepPictureSettings settings_;
  Environment environment_;
  DisplaySettings display_;
  Camera camera_;
  gl::HeadlessContext context_;
  std::optional<ReferenceHalves> reference_;
  std::map<int, SgEnvironment> prefiltered_;
  std::optional<Renderer> renderer_;
};

}  // namespace chiaro
