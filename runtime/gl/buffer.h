#pragma once
/// GL buffers (storage, uniform, vertex, index) and vertex arrays, through direct state access.

#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "runtime/gl/handle.h"

namespace chiaro::gl {

struct BufferDeleter {
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};

/// Fixed size, contents replaceable. Sizes and offsets in bytes.
class Buffer {
 public:
  Buffer() = default;
  /// `bytes` > 0; contents undefined.
  explicit Buffer(std::size_t bytes);
  template <class T>
  explicit Buffer(std::span<const T> values) : Buffer(values.size_bytes()) {
    write(0, values);
  }
  template <class T>
  explicit Buffer(const std::vector<T>& values) : Buffer(std::span<const T>(values)) {}

  GLuint id() const { return handle_.id(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }
  std::size_t size() const { return size_; }

  /// Throws std::out_of_range when the range leaves the buffer.
  void writeBytes(std::size_t offset, const void* data, std::size_t bytes);
  void readBytes(std::size_t offset, void* data, std::size_t bytes) const;

  template <class T>
  void write(std::size_t offset, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    writeBytes(offset, values.data(), values.size_bytes());
  }
  /// The whole buffer as T. Waits for the GPU; issue glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT) after shader writes.
  template <class T>
  std::vector<T> read() const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(size_ / sizeof(T));
    readBytes(0, values.data(), values.size() * sizeof(T));
    return values;
  }

  /// target: GL_SHADER_STORAGE_BUFFER or GL_UNIFORM_BUFFER.
  void bindBase(GLenum target, GLuint index) const { glBindBufferBase(target, index, id()); }

 private:
  void requireRange(std::size_t offset, std::size_t bytes) const;
  Handle<BufferDeleter> handle_;
  std::size_t size_ = 0;
};

struct VertexArrayDeleter {
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};

/// A vertex layout. A full-screen triangle from gl_VertexID needs one with no attributes.
class VertexArray {
 public:
  VertexArray() = default;
  static VertexArray create();

  GLuint id() const { return handle_.id(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }
  void bind() const { glBindVertexArray(id()); }
  /// `components` floats (or normalised integers) at `offset` in elements of `stride` bytes; buffer slot = attribute number.
  void attribute(GLuint index, const Buffer& buffer, GLint components, GLenum type, bool normalised, std::size_t offset, std::size_t stride);
  void indices(const Buffer& buffer) { glVertexArrayElementBuffer(id(), buffer.id()); }

 private:
  Handle<VertexArrayDeleter> handle_;
};

}  // namespace chiaro::gl
