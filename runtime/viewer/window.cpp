#include "runtime/viewer/window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "assets/error.h"

namespace chiaro {
namespace {

Error windowError(const std::string& what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return {ExitCode::failed, "window", what + (reason == nullptr ? "" : std::string(" (") + reason + ")"),
          "set DISPLAY or WAYLAND_DISPLAY, or use --headless"};
}

std::optional<Window::Key> keyOf(int key) {
  switch (key) {
    case GLFW_KEY_F: return Window::Key::frame;
    case GLFW_KEY_LEFT: return Window::Key::left;
    case GLFW_KEY_RIGHT: return Window::Key::right;
    case GLFW_KEY_UP: return Window::Key::up;
    case GLFW_KEY_DOWN: return Window::Key::down;
    default: return std::nullopt;
  }
}

/// Size in the desktop's units that gives a framebuffer of `pixels`.
glm::ivec2 windowUnits(GLFWwindow* window, glm::ivec2 pixels) {
  glm::ivec2 units, framebuffer;
  glfwGetWindowSize(window, &units.x, &units.y);
  glfwGetFramebufferSize(window, &framebuffer.x, &framebuffer.y);
  if (framebuffer.x <= 0 || framebuffer.y <= 0) return pixels;
  return {std::max(1, pixels.x * units.x / framebuffer.x), std::max(1, pixels.y * units.y / framebuffer.y)};
}

}  // namespace

/// GLFW's C callbacks; installed before Dear ImGui's, which passes every event on.
struct Window::Callbacks {
  static Window& self(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }
  static void touch(GLFWwindow* window) { self(window).activity_ = true; }
  static void button(GLFWwindow* window, int, int, int) { touch(window); }
  static void position(GLFWwindow* window, double, double) { touch(window); }
  static void scroll(GLFWwindow* window, double, double) { touch(window); }
  static void character(GLFWwindow* window, unsigned int) { touch(window); }
  static void resize(GLFWwindow* window, int, int) { touch(window); }
  static void refresh(GLFWwindow* window) { touch(window); }
  static void key(GLFWwindow* window, int key, int, int action, int) {
    touch(window);
    if (action == GLFW_RELEASE) return;
    if (const auto known = keyOf(key)) self(window).keys_.push_back(*known);
  }
  static void drop(GLFWwindow* window, int count, const char** paths) {
    touch(window);
    for (int i = 0; i < count; ++i) self(window).dropped_.emplace_back(paths[i]);
  }
  static void install(GLFWwindow* window, Window* owner) {
    glfwSetWindowUserPointer(window, owner);
    glfwSetMouseButtonCallback(window, button);
    glfwSetCursorPosCallback(window, position);
    glfwSetScrollCallback(window, scroll);
    glfwSetCharCallback(window, character);
    glfwSetFramebufferSizeCallback(window, resize);
    glfwSetWindowRefreshCallback(window, refresh);
    glfwSetKeyCallback(window, key);
    glfwSetDropCallback(window, drop);
  }
};

Window::Window(glm::ivec2 size, const std::string& title) {
  const auto isSet = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  // GLFW 3.4 would ask libwayland even then, which prints a complaint of its own.
  if (!isSet("DISPLAY") && !isSet("WAYLAND_DISPLAY"))
    throw Error(ExitCode::failed, "window", "there is no display", "set DISPLAY or WAYLAND_DISPLAY, or use --headless");
#ifdef GLFW_PLATFORM
  if (!isSet("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() != GLFW_TRUE) throw windowError("cannot open one");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const Error error = windowError("no OpenGL 4.5 core context");
    glfwTerminate();
    throw error;
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  const glm::ivec2 units = windowUnits(window_, size);
  if (units != size) glfwSetWindowSize(window_, units.x, units.y);
  debugLog_ = std::make_unique<gl::DebugLog>();
  debugLog_->install();

  Callbacks::install(window_, this);
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leave no file behind in the user's folder
  float scale = 1.0f, scaleY = 1.0f;
  glfwGetWindowContentScale(window_, &scale, &scaleY);
  ImGui::GetIO().FontGlobalScale = scale;
  ImGui::GetStyle().ScaleAllSizes(scale);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Window::~Window() {
  glfwMakeContextCurrent(window_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  debugLog_.reset();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::pollEvents(double seconds) {
  if (seconds > 0.0) glfwWaitEventsTimeout(seconds);
  else glfwPollEvents();
}

glm::ivec2 Window::framebufferSize() const {
  glm::ivec2 size;
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }
void Window::copyToClipboard(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

void Window::clear() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

void Window::beginPanel() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::endPanelAndSwap() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window_);
}

bool Window::takeActivity() { return std::exchange(activity_, false); }
std::vector<Window::Key> Window::takeKeys() { return std::exchange(keys_, {}); }
std::vector<std::filesystem::path> Window::takeDroppedFiles() { return std::exchange(dropped_, {}); }

}  // namespace chiaro
