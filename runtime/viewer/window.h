#pragma once
/// A GLFW window with an OpenGL 4.5 core context and Dear ImGui in it.

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "runtime/gl/debug_log.h"

struct GLFWwindow;

namespace chiaro {

class Window {
 public:
  enum class Key { frame, left, right, up, down };

  /// Visible, its framebuffer of this size where the desktop allows. Its context is current afterwards.
  /// Throws Error (failed) when there is no display or no OpenGL 4.5 core.
  Window(glm::ivec2 size, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool closing() const;
  /// Handles what has happened; with `seconds` above 0, first sleeps until something happens or they are over.
  void pollEvents(double seconds = 0.0);
  /// In pixels; 0 while the window is minimised.
  glm::ivec2 framebufferSize() const;
  void setTitle(const std::string& title);
  void copyToClipboard(const std::string& text);

  /// Framebuffer 0, to black.
  void clear();
  void beginPanel();
  /// Draws the panel over framebuffer 0 and shows both.
  void endPanelAndSwap();

  /// Counts keys, buttons, motion, resizing and files since the last call: something may look different.
  bool takeActivity();
  std::vector<Key> takeKeys();
  std::vector<std::filesystem::path> takeDroppedFiles();
  gl::DebugLog& debugLog() { return *debugLog_; }

 private:
  struct Callbacks;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<gl::DebugLog> debugLog_;
  bool activity_ = true;
  std::vector<Key> keys_;
  std::vector<std::filesystem::path> dropped_;
};

}  // namespace chiaro
