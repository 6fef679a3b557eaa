#include "runtime/gl/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <vector>

#include "assets/error.h"

namespace chiaro::gl {
namespace {

struct Candidate {
  EGLDisplay display;
  std::string name;
};

bool hasClientExtension(const char* name) { return epoxy_has_egl_extension(EGL_NO_DISPLAY, name); }

/// epoxy aborts when libEGL is absent; ask the loader first so that the user gets a sentence instead.
void requireEglLibrary() {
  void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) {
    throw Error(ExitCode::failed, "OpenGL", "libEGL.so.1 is not installed", "install the package libegl1");
  }
  // Left open: epoxy opens the same library.
}

std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  if (!hasClientExtension("EGL_EXT_platform_base")) return found;
  if (hasClientExtension("EGL_MESA_platform_surfaceless")) {
    found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), "surfaceless"});
  }
  const bool devices = hasClientExtension("EGL_EXT_device_base") || hasClientExtension("EGL_EXT_device_enumeration");
  if (devices && hasClientExtension("EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 16> list{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(list.size()), list.data(), &count) == EGL_TRUE) {
      for (EGLint i = 0; i < count; ++i) {
        found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, list[static_cast<std::size_t>(i)], nullptr),
                         "device " + std::to_string(i)});
      }
    }
  }
  return found;
}

/// A current context on `display`, or the reason there is none.
EGLContext tryDisplay(EGLDisplay display, std::string& reason) {
  if (display == EGL_NO_DISPLAY) {
    reason = "no display";
    return EGL_NO_CONTEXT;
  }
  if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    reason = "eglInitialize failed";
    return EGL_NO_CONTEXT;
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
    reason = "no desktop OpenGL";
    return EGL_NO_CONTEXT;
  }
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count == 0) {
      reason = "no OpenGL configuration";
      return EGL_NO_CONTEXT;
    }
  }
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE, EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) {
    reason = "no OpenGL 4.5 core";
    return EGL_NO_CONTEXT;
  }
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    eglDestroyContext(display, context);
    reason = "no context without a surface";
    return EGL_NO_CONTEXT;
  }
  return context;
}

std::string glString(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string{} : reinterpret_cast<const char*>(text);
}

}  // namespace

HeadlessContext::HeadlessContext() {
  requireEglLibrary();
  std::string tried;
  for (const Candidate& candidate : candidates()) {
    std::string reason;
    if (EGLContext context = tryDisplay(candidate.display, reason); context != EGL_NO_CONTEXT) {
      display_ = candidate.display;
      context_ = context;
      platform_ = candidate.name;
      break;
    }
    tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + reason;
    if (candidate.display != EGL_NO_DISPLAY) eglTerminate(candidate.display);
  }
  if (context_ == nullptr) {
    throw Error(ExitCode::failed, "OpenGL",
                "no OpenGL 4.5 context without a window (" + (tried.empty() ? "no EGL platform" : tried) + ")",
                "install a graphics driver, or the package libgl1-mesa-dri for the software one");
  }
  renderer_ = glString(GL_RENDERER);
  version_ = glString(GL_VERSION);
  debugLog_ = std::make_unique<DebugLog>();
  debugLog_->install();
}

HeadlessContext::~HeadlessContext() {
  makeCurrent();
  debugLog_.reset();
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

void HeadlessContext::makeCurrent() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }

}  // namespace chiaro::gl
