#pragma once
/// An environment in GPU memory, and its part of a frame's uniforms.

#include <array>
#include <glm/glm.hpp>

#include "runtime/environment/sg_environment.h"
#include "runtime/gl/texture.h"
#include "runtime/render/frame_block.h"

namespace chiaro {

class GpuEnvironment {
 public:
  explicit GpuEnvironment(const SgEnvironment& environment);

  void bindTextures() const;  ///< units 5 and 6
  /// Lights, fixed-lobe radiance and irradiance of the rest for this rotation.
  void fill(FrameBlock& frame, const glm::mat3& worldFromEnvironment, const std::vector<glm::vec3>& directions, float directionSharpness) const;
  /// Luminance, of the whole sphere.
  float meanRadiance() const { return meanRadiance_; }
  std::size_t bytes() const { return bytes_; }

 private:
  SgEnvironment source_;  // pyramid and lights; the map itself lives on the GPU only
  std::array<glm::vec3, 25> restRadianceSh_{};  // environment frame: projection of the radiance without the lights
  float mapSharpness_ = 0.0f, meanRadiance_ = 0.0f;
  gl::Texture pyramid_, radiance_;
  std::size_t bytes_ = 0;
};

}  // namespace chiaro
