#include "precompute/mesh/transfer_probe.h"

#include <bit>
#include <cmath>
#include <limits>

namespace chiaro {

CoarseSsdf TransferProbe::trace(const Viewpoint& viewpoint, Scratch& scratch) const {
  texelsAbove(grid_, viewpoint.normal, scratch.cosine, scratch.above);
  scratch.rays += traceVisibility(rays_, grid_, viewpoint, scratch.above, scratch.visible);
  scratch.transform(viewpoint.normal, viewpoint.doubleSided, scratch.above, scratch.visible, scratch.above, scratch.visible, scratch.distances.data());
  CoarseSsdf ssdf(grid_.texelCount);
  for (std::size_t t = 0; t < grid_.texelCount; ++t)
    ssdf[t] = static_cast<std::int8_t>(std::lrint(127.0f / kMaxDistance * scratch.distances[grid_.rowMajor[t]]));
  return ssdf;
}

/// Each of four parts of the tiles is spread over the whole map.
bool TransferProbe::inPart(std::size_t tile, std::size_t part) const {
  const auto tilesPerRow = static_cast<std::size_t>(grid_.resolution) / 4;
  return (tile % tilesPerRow + 2 * (tile / tilesPerRow)) % 4 == part;
}

double TransferProbe::error(const Viewpoint& viewpoint, std::span<const glm::vec3> planes, std::span<const WeightedSsdf> corners,
                                 double enough, Scratch& scratch) const {
  double wrong = 0.0, seen = 0.0, all = 0.0;
  const auto value = [&] { return wrong > 0.0 ? wrong / std::sqrt(all * seen) : 0.0; };
  for (std::size_t part = 0; part < 4; ++part) {
    for (std::size_t tile = 0; tile < grid_.tileCount; ++tile) {
      if (!inPart(tile, part)) continue;
      const auto first = 16 * tile;
      std::uint32_t front = 0, back = 0;
      for (std::uint32_t lane = 0; lane < 16; ++lane) {
        const auto w = grid_.direction(first + lane);
        const bool above = glm::dot(viewpoint.normal, w) > 0.0f;
        if (!above && !viewpoint.doubleSided) continue;
        bool counts = true;
        for (const auto& plane : planes) counts = counts && (glm::dot(plane, w) > 0.0f) == above;
        (above ? front : back) |= static_cast<std::uint32_t>(counts) << lane;
      }
      const auto trace = [&](glm::vec3 origin, std::uint32_t which) -> std::uint32_t {
        if (which == 0) return 0;
        scratch.rays += static_cast<std::uint64_t>(std::popcount(which));
        return which & ~rays_.occluded16(origin, grid_.x.data() + first, grid_.y.data() + first, grid_.z.data() + first, which, 0.0f,
                                         std::numeric_limits<float>::infinity());
      };
      const auto visible = trace(viewpoint.front, front) | trace(viewpoint.back, back);
      for (std::uint32_t lane = 0; lane < 16; ++lane) {
        if (((front | back) >> lane & 1) == 0) continue;
        float distance = 0.0f;
        for (const auto& corner : corners) distance += corner.weight * static_cast<float>((*corner.ssdf)[first + lane]);
        const bool truth = (visible >> lane & 1) != 0, interpolated = distance > 0.0f;
        const double solidAngle = static_cast<double>(grid_.solidAngle[first + lane]);
        all += solidAngle;
        if (truth || interpolated) seen += solidAngle;
        if (truth != interpolated) wrong += solidAngle;
      }
    }
    if (!(value() > enough)) return value();
  }
  return value();
}

}  // namespace chiaro
