#include "precompute/horizon_masks.h"

#include <algorithm>
#include <cmath>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

/// Broadest lobe that reads the SSDF: where levels end, or any.
float broadest(const TransferRows::Layout& layout) {
  return layout.levels.empty() ? 3.0f : lobe32::kSsdfFrom * layout.levels.back().sharpness;
}

/// Normals of a cell, as a cap.
struct Cap {
  glm::dvec3 sum{0.0};
  glm::vec3 axis{0.0f};
  float leastCosine = 1.0f;
  bool used = false;
};

void addMap(int resolution, float sharpness, const Cap& cap, std::vector<float>& mask) {
  const float spread = std::acos(std::clamp(cap.leastCosine, -1.0f, 1.0f)) + 3.545f / static_cast<float>(resolution);
  for (int t = 0; t < resolution * resolution; ++t) {
    const auto w = lobe32::octahedralTexelDirection({t % resolution, t / resolution}, resolution);
    const float elevation = std::asin(std::clamp(glm::dot(w, cap.axis), -1.0f, 1.0f)) + spread;
    const float share =
        elevation >= 0.0f ? 1.0f : 2.0f * lobe32::sgHalfSpaceFraction(std::sin(std::max(elevation, -lobe32::kHalfPi)), sharpness);
    mask.push_back(std::min(share * share, 1.0f));
  }
}

}  // namespace

ColumnMasks horizonMasks(const std::vector<Viewpoint>& viewpoints, const TransferRows::Layout& layout, std::size_t columns,
                         int side) {
  const auto cells = static_cast<std::size_t>(side * side);
  std::vector<Cap> caps(cells + 1);  // the last: double-sided
  ColumnMasks result;
  for (const auto& viewpoint : viewpoints) {
    const auto place = lobe32::octahedralEncode(viewpoint.normal) * static_cast<float>(side);
    const auto at = [&](float x) { return std::clamp(static_cast<int>(x), 0, side - 1); };
    const auto cell = viewpoint.doubleSided ? cells : static_cast<std::size_t>(at(place.y) * side + at(place.x));
    caps[cell].sum += glm::dvec3(viewpoint.normal);
    caps[cell].used = true;
    result.ofRow.push_back(static_cast<std::uint16_t>(cell));
  }
  for (auto& cap : caps)
    cap.axis = glm::dot(cap.sum, cap.sum) > 0.0 ? glm::vec3(glm::normalize(cap.sum)) : glm::vec3(0.0f, 0.0f, 1.0f);
  for (std::size_t v = 0; v < viewpoints.size(); ++v) {
    auto& cap = caps[result.ofRow[v]];
    cap.leastCosine = std::min(cap.leastCosine, glm::dot(cap.axis, viewpoints[v].normal));
  }
  std::vector<std::uint16_t> number(caps.size());
  for (std::size_t c = 0; c < caps.size(); ++c) {
    if (!caps[c].used) continue;
    number[c] = static_cast<std::uint16_t>(result.masks.size());
    auto& mask = result.masks.emplace_back();
    if (c == cells) continue;
    addMap(layout.resolution, broadest(layout), caps[c], mask);
    for (const auto& level : layout.levels) addMap(level.resolution, level.sharpness, caps[c], mask);
    mask.resize(columns, 1.0f);
  }
  for (auto& cell : result.ofRow) cell = number[cell];
  return result;
}

}  // namespace chiaro
