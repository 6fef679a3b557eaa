#include "precompute/transfer_rows.h"

#include <algorithm>
#include <utility>

#include "precompute/elapsed.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/visibility.h"
#include "precompute/z_curve.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

/// Adds the time since `from` to `sum` and starts anew.
void lap(Clock::time_point& from, double& sum) {
  const auto now = Clock::now();
  sum += std::chrono::duration<double>(now - from).count();
  from = now;
}

/// The coarsest map: the stored one, or one of about 64 texels a side below it. Traced everywhere unless narrower things are asked for.
int coarseBelow(int resolution) {
  while (resolution > 64 && resolution % 16 == 0) resolution /= 2;
  return resolution;
}

/// Positions in `vertices`, those with like normals beside each other: what a batch has below all its horizons is not filtered.
std::vector<std::size_t> byNormal(std::span<const std::uint32_t> vertices, const std::vector<Viewpoint>& viewpoints) {
  constexpr unsigned kSide = 16;
  std::vector<std::pair<unsigned, std::size_t>> keyed;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto place = lobe32::octahedralEncode(viewpoints[vertices[i]].normal) * static_cast<float>(kSide);
    const auto cell = [](float x) { return static_cast<unsigned>(std::clamp(x, 0.0f, kSide - 1.0f)); };
    keyed.emplace_back(zCurve(cell(place.x), cell(place.y), kSide), i);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::size_t> order;
  for (const auto& [key, i] : keyed) order.push_back(i);
  return order;
}

}  // namespace

void TraceTally::operator+=(const TraceTally& other) {
  rays += other.rays;
  visibilitySeconds += other.visibilitySeconds;
  ssdfSeconds += other.ssdfSeconds;
  filterSeconds += other.filterSeconds;
}

TransferRows::TransferRows(const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const Layout& layout)
    : rays_(rays),
      viewpoints_(viewpoints),
      layout_(layout),
      stored_(layout.resolution),
      sampled_(layout.samplingResolution),
      sphere_(coarseBelow(layout.resolution), layout.samplingResolution, layout.leastOccluder),
      prefilter_(sampled_, layout.levels),
      fractions_(stored_, layout.directions, layout.directionSharpness) {}

TraceTally TransferRows::operator()(std::span<const std::uint32_t> vertices, float* rows, std::size_t stride) const {
  constexpr std::size_t kBatch = PrefilteredVisibility::kBatch;
  TraceTally tally;
  AdaptiveVisibility adaptive(rays_, sphere_);
  AlignedFloats cosine(stored_.texelCount);
  TexelBits above[kBatch], visible[kBatch], storedAbove, storedVisible;
  Viewpoint viewpoints[kBatch];
  SsdfTransform transform(sampled_, stored_, layout_.clamp);
  auto scratch = prefilter_.scratch();
  const auto order = byNormal(vertices, viewpoints_);
  for (std::size_t first = 0; first < vertices.size(); first += kBatch) {
    const auto count = std::min(kBatch, vertices.size() - first);
    float* levels[kBatch] = {};
    for (std::size_t i = 0; i < count; ++i) {
      const auto place = order[first + i];
      float* row = rows + place * stride;
      levels[i] = row + texels();
      const auto& viewpoint = viewpoints[i] = viewpoints_[vertices[place]];
      auto time = Clock::now();
      tally.rays += adaptive(viewpoint);
      above[i] = adaptive.above();
      visible[i] = adaptive.visible();
      adaptive.at(layout_.resolution, storedAbove, storedVisible);
      lap(time, tally.visibilitySeconds);
      transform(viewpoint.normal, viewpoint.doubleSided, above[i], visible[i], storedAbove, storedVisible, row);
      if (layout_.softness > 0.0f) std::transform(row, row + texels(), row, [&](float distance) { return lobe32::ssdfSoftened(distance, layout_.softness); });
      lap(time, tally.ssdfSeconds);
      texelsAbove(stored_, viewpoint.normal, cosine, storedAbove);
      fractions_(viewpoint, cosine, storedAbove, storedVisible, row + texels() + levelTexels());
      lap(time, tally.filterSeconds);
    }
    if (layout_.levels.empty()) continue;
    auto time = Clock::now();
    prefilter_(count, viewpoints, above, visible, levels, scratch);
    lap(time, tally.filterSeconds);
  }
  return tally;
}

}  // namespace chiaro
