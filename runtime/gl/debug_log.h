#pragma once
/// What the GL driver says about our calls (KHR_debug), kept so that a test or a program can refuse to go on.

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace chiaro::gl {

/// Collects every message of severity high and every message of type error, from `install()` to destruction.
/// Must stay at the same address while installed, and the context must be current in install and in the destructor.
class DebugLog {
 public:
  DebugLog() = default;
  DebugLog(const DebugLog&) = delete;
  DebugLog& operator=(const DebugLog&) = delete;
  ~DebugLog();

  /// Synchronous callback on the current context: a message arrives before the call that caused it returns.
  void install();
  const std::vector<std::string>& messages() const { return messages_; }
  void clear() { messages_.clear(); }
  /// Throws Error (failed) quoting the first message, when there is one.
  void requireClean(const std::string& during) const;

 private:
  static void GLAPIENTRY receive(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                 const GLchar* message, const void* user);
  std::vector<std::string> messages_;
  bool installed_ = false;
};

}  // namespace chiaro::gl
