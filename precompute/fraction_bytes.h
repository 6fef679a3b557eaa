#pragma once
/// The visible fractions of the fixed lobes, where they are stored vertex by vertex.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "assets/transfer/transfer.h"

namespace chiaro {

inline void toFractionBytes(const float* fractions, std::size_t count, std::uint8_t* out) {
  for (std::size_t j = 0; j < count; ++j) out[j] = static_cast<std::uint8_t>(std::lrint(255.0f * fractions[j]));
}

/// Where each vertex of the scene, in the order of its primitives, has its bytes in `transfer`. Vertices may be set from several threads.
class FractionBytes {
 public:
  FractionBytes(const Scene& scene, Transfer& transfer) : directionCount_(static_cast<std::size_t>(transfer.directionCount)) {
    transfer.primitives.resize(scene.primitives.size());
    place_.reserve(scene.vertexCount());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
      auto& bytes = transfer.primitives[p].visibility;
      bytes.resize(scene.primitives[p].positions.size() * directionCount_);
      for (std::size_t i = 0; i < scene.primitives[p].positions.size(); ++i) place_.push_back(bytes.data() + i * directionCount_);
    }
  }
  void set(std::size_t vertex, const std::uint8_t* bytes) { std::memcpy(place_[vertex], bytes, directionCount_); }

 private:
  std::size_t directionCount_;
  std::vector<std::uint8_t*> place_;
};

}  // namespace chiaro
