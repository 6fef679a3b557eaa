#pragma once
/// Off-screen drawing targets.

#include <epoxy/gl.h>

#include <vector>

#include "runtime/gl/handle.h"
#include "runtime/gl/texture.h"

namespace chiaro::gl {

struct FramebufferDeleter {
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};

/// Refers to textures it does not own: they must outlive it.
class Framebuffer {
 public:
  Framebuffer() = default;
  /// Level 0 of each 2D texture in `colors` (attachment i), and `depth` when not null. All the same size.
  /// Throws Error (failed) when the driver calls the combination incomplete.
  static Framebuffer make(const std::vector<const Texture*>& colors, const Texture* depth = nullptr);
  /// One layer of one level of an array, 3D or cube-array texture as the only colour.
  static Framebuffer makeLayer(const Texture& color, int level, int layer);

  GLuint id() const { return handle_.id(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Binds for drawing and sets the viewport to the whole target.
  void bind() const;
  /// Colour attachment as RGBA float, bottom row first, 4·width·height values. Waits for the GPU.
  std::vector<float> readColor(int attachment = 0) const;

 private:
  void requireComplete() const;
  Handle<FramebufferDeleter> handle_;
  int width_ = 0, height_ = 0;
};

}  // namespace chiaro::gl
