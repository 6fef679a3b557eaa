#pragma once
/// What each vertex sees of each SG light: the same for every pixel, and for every frame until a light or the vertex' body turns.

#include <glm/glm.hpp>
#include <vector>

#include "runtime/gl/buffer.h"
#include "runtime/gl/program.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/gpu_transfer.h"

namespace chiaro {

struct VertexRange {
  std::size_t first = 0, count = 0;
};

class LightVisibility {
 public:
  explicit LightVisibility(const GpuTransfer& transfer);

  /// Binds the results; `frame` of this body must be bound already. Nothing in a scene without occlusion.
  void update(std::size_t body, const FrameBlock& frame, const std::vector<VertexRange>& vertices);

 private:
  const GpuTransfer& transfer_;
  gl::Program program_;
  gl::Buffer buffer_;
  std::vector<std::vector<glm::vec4>> known_;  // by body: axes and sharpness that the buffer holds
};

}  // namespace chiaro
