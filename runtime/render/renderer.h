#pragma once
/// Draws a baked scene under an environment. Needs a current OpenGL 4.5 core context, of a window or headless.

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assets/image/display.h"
#include "assets/image/image.h"
#include "assets/scene/scene.h"
#include "assets/transfer/transfer.h"
#include "runtime/environment/sg_environment.h"

namespace chiaro {

enum class DebugView { none, albedo, normal, roughness, visibility, ssdf };

struct RenderSettings {
  int width = 1280;
  int height = 720;
  int supersample = 1;                       ///< n^2 shaded points a pixel, box-filtered before the tone map, 1..8
  glm::mat3 worldFromEnvironment{1.0f};      ///< a rotation, free to change each frame
  float exposure = 1.0f;                     ///< factor on radiance before the tone map
  ToneMap toneMap = ToneMap::neutral;
  bool shadows = true;
  bool energyCompensation = false;           ///< GGX gives back what scatters more than once between its facets
  int lobes = 0;                             ///< 1, 3, 5, 7 or 9 (GGX three times as many): strings of so many for every material; 0: the best known
  bool background = true;                    ///< show the environment behind the scene
  DebugView debugView = DebugView::none;
};

struct FrameTimings {
  /// Pass name and GPU milliseconds (GL timer queries), in drawing order; the last is "total".
  std::vector<std::pair<std::string, double>> passes;
};

/// What of the scene a Renderer leaves out, in one line; empty when it draws everything.
std::string leftOut(const Scene& scene);

class Renderer {
 public:
  /// Uploads the scene; keeps no reference. Throws Error when the driver is too small for it.
  explicit Renderer(const BakedScene& baked);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  void setEnvironment(const SgEnvironment& environment);
  /// Material parameters may change every frame at no other cost than this upload; count and textures as in the scene. The first time
  /// that a model or a coat comes in which no material had before costs a compilation, and a model its table.
  void setMaterials(const std::vector<Material>& materials);

  /// Renders one frame into the renderer's own targets.
  void render(const Camera& camera, const RenderSettings& settings);
  /// Copies the last frame, tone-mapped and sRGB-encoded, to the bound window framebuffer (0) of this size.
  void present(int windowWidth, int windowHeight);

  /// The last frame: linear radiance before exposure, alpha = coverage (1 on an object, 0 on the background).
  ImageRgba readRadiance();
  /// The last frame as the screen shows it.
  Image8 readDisplay();
  /// Of the last frame; waits for the GPU.
  FrameTimings timings();
  /// Bytes of GPU memory held in textures and buffers.
  std::size_t gpuBytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chiaro
