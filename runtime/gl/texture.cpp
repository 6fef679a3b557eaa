#include "runtime/gl/texture.h"

#include <algorithm>
#include <bit>
#include <string>

#include "assets/error.h"

namespace chiaro::gl {
namespace {

int driverLimit(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

void requireAtMost(const char* what, int value, int limit) {
  if (value >= 1 && value <= limit) return;
  throw Error(ExitCode::failed, "OpenGL", std::string("texture ") + what + " " + std::to_string(value) + " is outside 1.." + std::to_string(limit),
              "use a smaller one, or for a picture fewer points a pixel");
}

bool isFilterable(GLenum internalFormat) {
  GLint filterable = GL_NONE;
  glGetInternalformativ(GL_TEXTURE_2D, internalFormat, GL_FILTER, 1, &filterable);
  GLint depth = GL_FALSE;
  glGetInternalformativ(GL_TEXTURE_2D, internalFormat, GL_DEPTH_COMPONENTS, 1, &depth);
  return filterable != GL_NONE && depth == GL_FALSE;
}

struct PackedRows {
  // Tight rows: three-byte texels and odd widths are not multiples of GL's default alignment of four.
  PackedRows() {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
  }
  ~PackedRows() {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
  }
  PackedRows(const PackedRows&) = delete;
  PackedRows& operator=(const PackedRows&) = delete;
};

int levelSize(int size, int level) { return std::max(1, size >> level); }

}  // namespace

Texture Texture::make(GLenum target, GLenum internalFormat, int width, int height, int layers, int levels) {
  const int sizeLimit = driverLimit(target == GL_TEXTURE_3D ? GL_MAX_3D_TEXTURE_SIZE
                                    : target == GL_TEXTURE_CUBE_MAP_ARRAY ? GL_MAX_CUBE_MAP_TEXTURE_SIZE
                                                                          : GL_MAX_TEXTURE_SIZE);
  requireAtMost("width", width, sizeLimit);
  requireAtMost("height", height, sizeLimit);
  requireAtMost("depth", layers, target == GL_TEXTURE_3D ? sizeLimit : driverLimit(GL_MAX_ARRAY_TEXTURE_LAYERS));
  const int largest = std::max({width, height, target == GL_TEXTURE_3D ? layers : 1});
  const int fullChain = std::bit_width(static_cast<unsigned>(largest));
  levels = levels <= 0 ? fullChain : std::min(levels, fullChain);

  Texture texture;
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  texture.handle_ = Handle<TextureDeleter>(id);
  texture.target_ = target;
  texture.internalFormat_ = internalFormat;
  texture.width_ = width;
  texture.height_ = height;
  texture.layers_ = layers;
  texture.levels_ = levels;
  if (target == GL_TEXTURE_2D) {
    glTextureStorage2D(id, levels, internalFormat, width, height);
  } else {
    glTextureStorage3D(id, levels, internalFormat, width, height, layers);
  }
  if (isFilterable(internalFormat)) {
    texture.filter(levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR, GL_LINEAR);
  } else {
    texture.filter(levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST, GL_NEAREST);
  }
  texture.wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  return texture;
}

Texture Texture::make2d(GLenum internalFormat, int width, int height, int levels) {
  return make(GL_TEXTURE_2D, internalFormat, width, height, 1, levels);
}

Texture Texture::make2dArray(GLenum internalFormat, int width, int height, int layers, int levels) {
  return make(GL_TEXTURE_2D_ARRAY, internalFormat, width, height, layers, levels);
}

Texture Texture::make3d(GLenum internalFormat, int width, int height, int depth, int levels) {
  return make(GL_TEXTURE_3D, internalFormat, width, height, depth, levels);
}

Texture Texture::makeCubeArray(GLenum internalFormat, int size, int cubes, int levels) {
  return make(GL_TEXTURE_CUBE_MAP_ARRAY, internalFormat, size, size, 6 * cubes, levels);
}

void Texture::upload(int level, GLenum format, GLenum type, const void* data) {
  const PackedRows packed;
  const int w = levelSize(width_, level), h = levelSize(height_, level);
  if (target_ == GL_TEXTURE_2D) {
    glTextureSubImage2D(id(), level, 0, 0, w, h, format, type, data);
  } else {
    const int d = target_ == GL_TEXTURE_3D ? levelSize(layers_, level) : layers_;
    glTextureSubImage3D(id(), level, 0, 0, 0, w, h, d, format, type, data);
  }
}

void Texture::uploadLayer(int level, int layer, GLenum format, GLenum type, const void* data) {
  if (target_ == GL_TEXTURE_2D) return upload(level, format, type, data);
  const PackedRows packed;
  glTextureSubImage3D(id(), level, 0, 0, layer, levelSize(width_, level), levelSize(height_, level), 1, format, type, data);
}

void Texture::download(int level, GLenum format, GLenum type, void* data, std::size_t bytes) const {
  const PackedRows packed;
  glGetTextureImage(id(), level, format, type, static_cast<GLsizei>(bytes), data);
}

void Texture::bindImage(GLuint unit, int level, GLenum access) const {
  glBindImageTexture(unit, id(), level, target_ == GL_TEXTURE_2D ? GL_FALSE : GL_TRUE, 0, access, internalFormat_);
}

void Texture::filter(GLenum minify, GLenum magnify) {
  glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Texture::wrap(GLenum s, GLenum t) {
  glTextureParameteri(id(), GL_TEXTURE_WRAP_S, static_cast<GLint>(s));
  glTextureParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(t));
}

}  // namespace chiaro::gl
