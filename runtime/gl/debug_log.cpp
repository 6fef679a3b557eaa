#include "runtime/gl/debug_log.h"

#include "assets/error.h"

namespace chiaro::gl {

DebugLog::~DebugLog() {
  if (installed_) glDebugMessageCallback(nullptr, nullptr);
}

void DebugLog::install() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(&DebugLog::receive, this);
  installed_ = true;
}

void DebugLog::requireClean(const std::string& during) const {
  if (messages_.empty()) return;
  throw Error(ExitCode::failed, during, "OpenGL error: " + messages_.front(),
              "report it with the output of --version and the graphics driver's name");
}

void GLAPIENTRY DebugLog::receive(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* message,
                                  const void* user) {
  // A failed compile is reported here too by some drivers; Program turns it into an Error with the right file and line.
  if (severity != GL_DEBUG_SEVERITY_HIGH && type != GL_DEBUG_TYPE_ERROR) return;
  // The C interface hands our own pointer back as const.
  auto* self = static_cast<DebugLog*>(const_cast<void*>(user));
  self->messages_.emplace_back(message, length < 0 ? std::char_traits<char>::length(message) : static_cast<std::size_t>(length));
}

}  // namespace chiaro::gl
