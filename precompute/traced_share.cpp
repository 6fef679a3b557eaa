#include "precompute/traced_share.h"

#include <bit>
#include <cstdint>
#include <limits>

namespace chiaro {

namespace {

/// seen(first, bits): of the sixteen directions from `first` on, those that are free.
void eachPacket(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions, const auto& seen) {
  alignas(64) float x[16] = {}, y[16] = {}, z[16] = {};
  for (std::size_t first = 0; first < directions.size(); first += 16) {
    std::uint32_t above = 0;  // of the last packet's lanes, those left over are not asked for
    for (std::size_t i = 0; i < 16 && first + i < directions.size(); ++i) {
      const auto w = directions[first + i];
      x[i] = w.x;
      y[i] = w.y;
      z[i] = w.z;
      if (glm::dot(w, normal) > 0.0f) above |= 1u << i;
    }
    if (above == 0) continue;
    const auto hidden = rays.occluded16(origin, x, y, z, above, 0.0f, std::numeric_limits<float>::infinity());
    seen(first, above & ~hidden);
  }
}

}  // namespace

double tracedShare(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions) {
  int count = 0;
  eachPacket(rays, origin, normal, directions, [&](std::size_t, std::uint32_t free) { count += std::popcount(free); });
  return static_cast<double>(count) / static_cast<double>(directions.size());
}

void tracedDirections(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions, std::vector<std::uint8_t>& free) {
  free.assign(directions.size(), 0);
  eachPacket(rays, origin, normal, directions, [&](std::size_t first, std::uint32_t bits) {
    for (std::size_t i = 0; i < 16 && first + i < free.size(); ++i) free[first + i] = bits >> i & 1u;
  });
}

}  // namespace chiaro
