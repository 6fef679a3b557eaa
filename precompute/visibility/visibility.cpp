#include "precompute/visibility/visibility.h"

#include <bit>
#include <limits>

namespace chiaro {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

}  // namespace

std::size_t nearestAbove(const OctahedralGrid& grid, const TexelBits& above, glm::vec3 direction) {
  const auto home = grid.texelAt(direction);
  if (texelBit(above.data(), home)) return home;
  auto best = home;
  float bestCosine = -2.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const auto t = grid.texelBeside(home, dx, dy);
      const float cosine = glm::dot(grid.direction(t), direction);
      if (texelBit(above.data(), t) && cosine > bestCosine) {
        best = t;
        bestCosine = cosine;
      }
    }
  }
  return best;
}

void texelsAbove(const OctahedralGrid& grid, glm::vec3 normal, AlignedFloats& cosine, TexelBits& above) {
  above.resize(grid.tileCount);
  const float *x = grid.x.data(), *y = grid.y.data(), *z = grid.z.data();
  float* dot = cosine.data();
  for (std::size_t t = 0; t < grid.texelCount; ++t) dot[t] = x[t] * normal.x + y[t] * normal.y + z[t] * normal.z;
  for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 16; ++lane) bits |= static_cast<unsigned>(dot[16 * tile + lane] > 0.0f) << lane;
    above[tile] = static_cast<std::uint16_t>(bits);
  }
}

void mirrorBelowHorizon(const OctahedralGrid& grid, glm::vec3 n, const TexelBits& above, TexelBits& visible) {
  for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
    for (unsigned below = static_cast<std::uint16_t>(~above[tile]); below != 0; below &= below - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(below));
      const auto w = grid.direction(16 * tile + lane);
      const auto source = nearestAbove(grid, above, w - 2.0f * glm::dot(w, n) * n);
      const unsigned bit = 1u << lane;
      visible[tile] = static_cast<std::uint16_t>(texelBit(visible.data(), source) ? visible[tile] | bit : visible[tile] & ~bit);
    }
  }
}

std::uint64_t traceVisibility(const RayScene& rays, const OctahedralGrid& grid, const Viewpoint& viewpoint, const TexelBits& above,
                              TexelBits& visible) {
  visible.resize(grid.tileCount);
  std::uint64_t traced = 0;
  for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
    const auto trace = [&](glm::vec3 origin, unsigned which) -> unsigned {
      if (which == 0) return 0;
      traced += static_cast<std::uint64_t>(std::popcount(which));
      const auto first = 16 * tile;
      return which & ~rays.occluded16(origin, grid.x.data() + first, grid.y.data() + first, grid.z.data() + first, which, 0.0f, kFar);
    };
    unsigned seen = trace(viewpoint.front, above[tile]);
    if (viewpoint.doubleSided) seen |= trace(viewpoint.back, static_cast<std::uint16_t>(~above[tile]));
    visible[tile] = static_cast<std::uint16_t>(seen);
  }
  if (!viewpoint.doubleSided) mirrorBelowHorizon(grid, viewpoint.normal, above, visible);
  return traced;
}

}  // namespace chiaro
