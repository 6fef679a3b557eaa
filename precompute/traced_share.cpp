#include "precompute/traced_share.h"

#include <bit>
#include <cstdint>
#include <limits>

namespace chiaro {

double tracedShare(const RayScene& rays, glm::vec3 origin, glm::vec3 normal, std::span<const glm::vec3> directions) {
  alignas(64) float x[16] = {}, y[16] = {}, z[16] = {};
  int seen = 0;
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
    seen += std::popcount(above & ~hidden);
  }
  return static_cast<double>(seen) / static_cast<double>(directions.size());
}

}  // namespace chiaro
