#pragma once
/// Immutable GL textures: 2D, 2D array, 3D and cube array, through direct state access.

#include <epoxy/gl.h>

#include <cstddef>
#include <vector>

#include "runtime/gl/handle.h"

namespace chiaro::gl {

struct TextureDeleter {
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};

/// Storage is fixed when made. `internalFormat` is sized (GL_RGBA16F, GL_SRGB8_ALPHA8, GL_R16_SNORM, GL_DEPTH_COMPONENT32F, ...).
/// New textures filter linearly (with mip-maps when levels > 1) and clamp to the edge; integer and depth ones use nearest.
/// levels 0 means the full chain. Throws Error (failed) when a size exceeds what the driver can do.
class Texture {
 public:
  Texture() = default;
  static Texture make2d(GLenum internalFormat, int width, int height, int levels = 1);
  static Texture make2dArray(GLenum internalFormat, int width, int height, int layers, int levels = 1);
  static Texture make3d(GLenum internalFormat, int width, int height, int depth, int levels = 1);
  /// `cubes` cubes of six faces; layer-face index is 6*cube + face in uploads.
  static Texture makeCubeArray(GLenum internalFormat, int size, int cubes, int levels = 1);

  GLuint id() const { return handle_.id(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }
  GLenum target() const { return target_; }
  GLenum internalFormat() const { return internalFormat_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Layers (2D array), slices (3D) or 6 × cubes (cube array); 1 for 2D.
  int layers() const { return layers_; }
  int levels() const { return levels_; }

  /// Whole level: `data` tightly packed, all layers one after another.
  void upload(int level, GLenum format, GLenum type, const void* data);
  /// One layer of one level.
  void uploadLayer(int level, int layer, GLenum format, GLenum type, const void* data);
  /// Whole level into `bytes` bytes at `data`, tightly packed.
  void download(int level, GLenum format, GLenum type, void* data, std::size_t bytes) const;
  void generateMipmaps() { glGenerateTextureMipmap(id()); }

  void bind(GLuint unit) const { glBindTextureUnit(unit, id()); }
  /// access: GL_READ_ONLY, GL_WRITE_ONLY, GL_READ_WRITE; all layers bound.
  void bindImage(GLuint unit, int level, GLenum access) const;
  void filter(GLenum minify, GLenum magnify);
  void wrap(GLenum s, GLenum t);

 private:
  static Texture make(GLenum target, GLenum internalFormat, int width, int height, int layers, int levels);
  Handle<TextureDeleter> handle_;
  GLenum target_ = 0, internalFormat_ = 0;
  int width_ = 0, height_ = 0, layers_ = 0, levels_ = 0;
};

}  // namespace chiaro::gl
