#pragma once
/// A run that ends: so many frames, one picture, one set of timings; the same code behind a window and without one.

#include <functional>
#include <string>

#include "runtime/gl/debug_log.h"
#include "runtime/render/renderer.h"
#include "runtime/viewer/view_inputs.h"
#include "runtime/viewer/view_options.h"

namespace chiaro {

/// What the driver says of itself.
struct GlFacts {
  std::string renderer, version, vendor;
  std::string platform;  ///< where the context came from: "surfaceless", "device 0", "window"
};
/// Of the current context.
GlFacts glFacts(const std::string& platform);

/// The settings of the options, under an environment of this automatic exposure.
RenderSettings renderSettings(const ViewOptions& options, float autoExposure);

/// The camera the options ask for. Throws Error (usage) when the scene does not have it.
Camera viewCamera(const ViewOptions& options, const Scene& scene);

/// Called after each frame, with the renderer holding it.
using FrameHandler = std::function<void(Renderer&, int frame)>;

/// Renders options.frames frames of `scene` in the current context and writes the picture and the timings.
/// Throws Error (failed) for what the driver cannot do or has complained about in `log`, Error (unwritableOutput).
void runFrames(const ViewOptions& options, const LoadedScene& scene, const Camera& camera, const PreparedEnvironment& environment,
               const GlFacts& facts, const gl::DebugLog& log, const FrameHandler& afterFrame = {});

/// The last frame: .png display-encoded, .exr linear radiance. Throws Error (unwritableOutput).
void savePicture(Renderer& renderer, const std::filesystem::path& path);

/// The whole of --headless: context, inputs, frames, files.
void viewHeadless(const ViewOptions& options);

}  // namespace chiaro
