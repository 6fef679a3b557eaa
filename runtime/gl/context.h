#pragma once
/// OpenGL 4.5 core without a window, through EGL.

#include <memory>
#include <string>

#include "runtime/gl/debug_log.h"

namespace chiaro::gl {

/// A context with no surface: all drawing goes to framebuffer objects. Current on the thread that made it.
/// Tries the Mesa surfaceless platform, then every EGL device.
class HeadlessContext {
 public:
  /// Throws Error (failed) naming each platform tried and why it was refused.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

  void makeCurrent();
  /// GL_RENDERER, GL_VERSION, and the EGL platform that gave the context ("surfaceless" or "device N").
  const std::string& renderer() const { return renderer_; }
  const std::string& version() const { return version_; }
  const std::string& platform() const { return platform_; }
  DebugLog& debugLog() { return *debugLog_; }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string renderer_, version_, platform_;
  std::unique_ptr<DebugLog> debugLog_;
};

}  // namespace chiaro::gl
