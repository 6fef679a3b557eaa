#pragma once
/// Draws a baked scene under an environment. Needs a current OpenGL 4.5 core context, of a window or headless.

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assets/image/image.h"
#include "assets/scene/scene.h"
#include "assets/scene/vertex_cache.h"
#include "assets/transfer/transfer.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/render/render_settings.h"
#include "runtime/render/shading_tape.h"
#include "runtime/render/wetness.h"

namespace chiaro {

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
  /// In place of the scene's own, the first 32 of them. May change every frame at no other cost than this upload.
  void setLights(const std::vector<Light>& lights);
  /// Material parameters may change every frame at no other cost than this upload; count and textures as in the scene. The first time
  /// that a model or a coat comes in which no material had before costs a compilation, and a model its table.
  void setMaterials(const std::vector<Material>& materials);

  /// On top of the materials. May change every frame at no other cost than the upload; the first map, and each one of another size, costs more: the
  /// first a compilation. Throws Error (failed) where the texels do not fill the size.
  void setWetness(const Wetness& wetness);

  /// Where each mesh of the scene (Scene::meshNames) stands: rotations and shifts from where it was baked, the identity at first. A moved mesh keeps
  /// the transfer that it was baked with, in its own frame: what hid it there still does, and its shadow on others stays behind.
  void setPoses(const std::vector<glm::mat4>& worldFromBaked);

  /// Primitives that change shape; the others stay as they are. Shaded with the transfer of the shape that was baked, in its directions: what hid a vertex there still does
  /// (RenderSettings::shadows turns that off). The first call costs a compilation and 16 bytes a vertex of the scene. Throws Error (failed) for other numbers of vertices.
  void setShapes(const std::vector<PrimitiveShape>& shapes);

  /// Renders one frame into the renderer's own targets.
  void render(const Camera& camera, const RenderSettings& settings);

  /// Renders a frame and returns what its opaque pixels asked. For studies of error: no supersampling, no upsampling and no debug view, else throws Error (usage).
  ShadingTape record(const Camera& camera, const RenderSettings& settings);
  /// Renders the same frame with the answers of a tape that record() made with the same arguments; blended surfaces have their own.
  void replay(const Camera& camera, const RenderSettings& settings, const ShadingTape& answered);

  /// Copies the last frame, tone-mapped and sRGB-encoded, to the bound window framebuffer (0) of this size.
  void present(int windowWidth, int windowHeight);

  /// The last frame: linear radiance before exposure, alpha = coverage (1 on an object, 0 on the background).
  ImageRgba readRadiance();
  /// The last frame as the screen shows it.
  Image8 readDisplay();
  /// Pixels that the last frame's filter failed, and how many of them were shaded; 0 without upsampling. Waits for the GPU.
  std::pair<unsigned, unsigned> recomputed() const;
  /// Of the last frame; waits for the GPU.
  FrameTimings timings();
  /// Bytes of GPU memory held in textures and buffers.
  std::size_t gpuBytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chiaro
