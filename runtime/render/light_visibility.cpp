#include "runtime/render/light_visibility.h"

#include <algorithm>
#include <cstdint>

namespace chiaro {

LightVisibility::LightVisibility(const GpuTransfer& transfer) : transfer_(transfer) {
  if (transfer.occludes()) program_ = gl::Program::loadCompute("shaders/stage/light_visibility.comp", transfer.defines());
}

void LightVisibility::update(std::size_t body, const FrameBlock& frame, const std::vector<VertexRange>& vertices) {
  if (!transfer_.occludes() || frame.counts.x == 0) return;
  std::vector<glm::vec4> wanted;
  for (int l = 0; l < frame.counts.x; ++l) wanted.push_back(frame.sgLights[l].axisSharpness);
  const std::size_t bytes = sizeof(std::uint32_t) * transfer_.vertexCount() * wanted.size();
  if (!buffer_ || buffer_.size() < bytes) {
    buffer_ = gl::Buffer(bytes);
    known_.clear();
  }
  buffer_.bindBase(GL_SHADER_STORAGE_BUFFER, 5);
  if (known_.size() <= body) known_.resize(body + 1);
  if (wanted == known_[body]) return;
  program_.use();
  const std::size_t row = 32768;  // of work groups; a driver need not take more than 65535 in one dimension
  program_.set("rowGroups", static_cast<int>(row));
  for (const auto& range : vertices) {
    const auto groups = (range.count + 63) / 64;
    program_.set("firstVertex", static_cast<unsigned>(range.first));
    program_.set("vertexCount", static_cast<unsigned>(range.count));
    glDispatchCompute(static_cast<GLuint>(std::min(groups, row)), static_cast<GLuint>((groups + row - 1) / row), 1);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  known_[body] = std::move(wanted);
}

}  // namespace chiaro
