#pragma once
/// Shades one pixel of each cell of n by n and makes the rest of them: a joint filter over place, depth, lobes and time (Herzog et al. 2010; Tokuyoshi
/// 2015), and shading of the pixels that it fails. Owned by a Renderer, which draws the geometry and binds what shading reads.

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "assets/scene/scene.h"
#include "runtime/gl/buffer.h"
#include "runtime/gl/framebuffer.h"
#include "runtime/gl/program.h"
#include "runtime/gl/texture.h"
#include "runtime/render/render_settings.h"

namespace chiaro {

class Upsampler {
 public:
  Upsampler();

  /// The programs that shade, with what the scene asks of them; `shapes`: vertices have places in the frame before of their own.
  void build(const std::vector<std::string>& defines, bool shapes);

  /// Before anything else of a frame: targets of this size, history where the last frame left any. `color` and `depth` are the renderer's own
  /// and must live until the frame is done.
  /// `meanRadiance` is the environment's.
  void begin(const gl::Texture& color, const gl::Texture& depth, const Camera& camera, const RenderSettings& settings, float meanRadiance);
  /// Nothing of the frames so far may show in the next.
  void forget() { historyHolds_ = false; }

  /// Target and program of the geometry pass; `clipFromWorldBefore` of the frame before, for the body drawn next.
  void bindSurfaces() const;
  const gl::Program& surfaceProgram() const { return surfaceProgram_; }
  void setBody(int body, const glm::mat4& clipFromWorldBefore) const;

  /// What every pixel's light will be filtered by. Calls `bindBody` with each body from 0 on before it reads what is seen of it; `depth` is the frame's own.
  void estimate(int bodies, const std::function<void(int)>& bindBody, const gl::Texture& depth) const;
  /// Calls `bindBody` with each body from 0 on before it shades what is seen of it.
  void shade(int bodies, const std::function<void(int)>& bindBody) const;
  void filter();
  /// `pixels`: the most that are shaded.
  void recompute(int bodies, const std::function<void(int)>& bindBody, unsigned pixels);
  /// Holds how many pixels were listed for it, a 32 bit word at kListedOffset.
  const gl::Buffer& listed() const { return urgencies_; }
  static constexpr std::size_t kListedOffset = 64 * sizeof(std::uint32_t);  // shaders/stage/upsample_list.glsl

  /// Adds the light to `color`, or puts a debug view there. Ends the frame.
  void compose();

  /// Pixels that asked to be shaded in the last frame, and that were; none without a budget. Waits for the GPU.
  std::pair<unsigned, unsigned> recomputed() const;
  std::size_t bytes() const;

 private:
  /// What one frame leaves to the next, at full resolution.
  struct Kept {
    gl::Texture diffuse, reflected, guide;
  };
  void allocate(glm::ivec2 size, int cell);
  void setHistory(const gl::Program& program) const;

  gl::Program surfaceProgram_, estimateProgram_, shadeProgram_, recomputeProgram_, filterProgram_, cutProgram_, listProgram_, composeProgram_;
  glm::ivec2 size_{0}, coarse_{0};
  int cell_ = 0, frame_ = 0, now_ = 0;
  bool recomputes_ = false;
  unsigned budget_ = 0;
  gl::Texture place_, colors_, before_, body_, albedos_, guide_, quality_;
  gl::Texture coarseDiffuse_, coarseReflected_, coarseGuide_;
  Kept kept_[2];
  gl::Framebuffer surfaces_, estimated_, coarseTarget_, filtered_[2], composed_;
  gl::Buffer urgencies_, pixels_;
  RenderSettings settings_;
  float darkest_ = 0.0f;
  bool historyHolds_ = false;
  glm::ivec2 jitter_{0};
  glm::vec2 depthScale_{0.0f}, depthScaleBefore_{0.0f};
};

}  // namespace chiaro
