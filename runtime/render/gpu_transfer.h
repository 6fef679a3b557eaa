#pragma once
/// The compressed transfer of a baked scene in GPU memory. The global form is one cluster, so shaders know only clusters.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "assets/transfer/transfer.h"
#include "runtime/gl/buffer.h"
#include "runtime/gl/texture.h"

namespace chiaro {

/// Throws Error when the driver takes no storage buffer of so many bytes; `what` it is for, in the plural.
void requireStorage(std::size_t bytes, const char* what);

class GpuTransfer {
 public:
  GpuTransfer() = default;
  /// Throws Error when the driver's limits are too small.
  explicit GpuTransfer(const BakedScene& baked);

  /// Whether anything in the scene is occluded; without it there is nothing to bind.
  bool occludes() const { return occludes_; }
  int directionVectors() const { return directionVectors_; }
  std::size_t vertexCount() const { return vertexCount_; }
  /// What shaders/stage/transfer.glsl is built with.
  std::vector<std::string> defines() const;
  void bind() const;
  std::size_t bytes() const;

 private:
  /// Maps of all clusters, one four-channel cell for four terms, the means in cells of their own.
  struct Cells {
    gl::Texture means, terms;
    int columns = 1;  ///< cells side by side in a layer, where there are more of them than a texture array has layers
  };
  void uploadWeights(const Transfer& transfer);
  void uploadGlobal(const Transfer& transfer);
  void uploadClusters(const Transfer& transfer);

  bool occludes_ = false;
  int directionVectors_ = 0, termVectors_ = 0, slots_ = 1, weightBits_ = 16, resolution_ = 0;
  float softness_ = 0.0f;
  std::vector<VisibilityLevel> levels_;
  std::size_t vertexCount_ = 0;
  gl::Buffer visibility_, weights_, vertices_, clusters_;
  Cells ssdf_, level_;
};

}  // namespace chiaro
