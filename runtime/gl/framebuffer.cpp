#include "runtime/gl/framebuffer.h"

#include <algorithm>
#include <cstdio>

#include "assets/error.h"

namespace chiaro::gl {
namespace {

GLuint createFramebuffer() {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  return id;
}

}  // namespace

Framebuffer Framebuffer::make(const std::vector<const Texture*>& colors, const Texture* depth) {
  Framebuffer target;
  target.handle_ = Handle<FramebufferDeleter>(createFramebuffer());
  std::vector<GLenum> drawBuffers;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
    glNamedFramebufferTexture(target.id(), attachment, colors[i]->id(), 0);
    drawBuffers.push_back(attachment);
  }
  if (depth != nullptr) glNamedFramebufferTexture(target.id(), GL_DEPTH_ATTACHMENT, depth->id(), 0);
  glNamedFramebufferDrawBuffers(target.id(), static_cast<GLsizei>(drawBuffers.size()), drawBuffers.data());
  const Texture* first = colors.empty() ? depth : colors.front();
  target.width_ = first == nullptr ? 0 : first->width();
  target.height_ = first == nullptr ? 0 : first->height();
  target.requireComplete();
  return target;
}

Framebuffer Framebuffer::makeLayer(const Texture& color, int level, int layer) {
  Framebuffer target;
  target.handle_ = Handle<FramebufferDeleter>(createFramebuffer());
  glNamedFramebufferTextureLayer(target.id(), GL_COLOR_ATTACHMENT0, color.id(), level, layer);
  glNamedFramebufferDrawBuffer(target.id(), GL_COLOR_ATTACHMENT0);
  target.width_ = std::max(1, color.width() >> level);
  target.height_ = std::max(1, color.height() >> level);
  target.requireComplete();
  return target;
}

void Framebuffer::requireComplete() const {
  const GLenum status = glCheckNamedFramebufferStatus(id(), GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return;
  char what[96];
  std::snprintf(what, sizeof what, "the driver cannot draw to a picture of %dx%d (framebuffer status 0x%04x)", width_, height_, status);
  throw Error(ExitCode::failed, "OpenGL", what, "use a smaller picture or fewer points a pixel");
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, id());
  glViewport(0, 0, width_, height_);
}

std::vector<float> Framebuffer::readColor(int attachment) const {
  std::vector<float> pixels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
  glNamedFramebufferReadBuffer(id(), static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + attachment));
  GLint previous = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &previous);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, id());
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels.data());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(previous));
  return pixels;
}

}  // namespace chiaro::gl
