#pragma once
/// What the shaders read of a frame, in the rest frame of one body: a body that moves is shaded where it was baked, with viewer and light carried
/// there, so that its transfer still holds.

#include <glm/glm.hpp>
#include <vector>

#include "assets/scene/scene.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/gpu_environment.h"
#include "runtime/render/gpu_scene.h"
#include "runtime/render/render_settings.h"

namespace chiaro {

glm::mat4 clipFromWorld(const Camera& camera, float aspect);

/// `worldFromRest`: a rotation and a shift. At most kMaxPunctualLights lights.
FrameBlock frameBlock(const Camera& camera, const RenderSettings& settings, const GpuEnvironment& environment, const GpuScene& scene,
                      const std::vector<Light>& lights, const glm::mat4& worldFromRest);

}  // namespace chiaro
