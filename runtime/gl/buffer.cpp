#include "runtime/gl/buffer.h"

#include <stdexcept>

namespace chiaro::gl {

Buffer::Buffer(std::size_t bytes) : size_(bytes) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  handle_ = Handle<BufferDeleter>(id);
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
}

void Buffer::requireRange(std::size_t offset, std::size_t bytes) const {
  if (offset > size_ || bytes > size_ - offset) throw std::out_of_range("gl::Buffer: range outside the buffer");
}

void Buffer::writeBytes(std::size_t offset, const void* data, std::size_t bytes) {
  requireRange(offset, bytes);
  if (bytes > 0) glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::readBytes(std::size_t offset, void* data, std::size_t bytes) const {
  requireRange(offset, bytes);
  if (bytes > 0) glGetNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

VertexArray VertexArray::create() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  VertexArray array;
  array.handle_ = Handle<VertexArrayDeleter>(id);
  return array;
}

void VertexArray::attribute(GLuint index, const Buffer& buffer, GLint components, GLenum type, bool normalised, std::size_t offset,
                            std::size_t stride) {
  glVertexArrayVertexBuffer(id(), index, buffer.id(), 0, static_cast<GLsizei>(stride));
  glEnableVertexArrayAttrib(id(), index);
  glVertexArrayAttribFormat(id(), index, components, type, normalised ? GL_TRUE : GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(id(), index, index);
}

}  // namespace chiaro::gl
