#include "precompute/transfer_rows.h"

#include <algorithm>
#include <chrono>

#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {
namespace {

using Clock = std::chrono::steady_clock;

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
  for (std::size_t first = 0; first < vertices.size(); first += kBatch) {
    const auto count = std::min(kBatch, vertices.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      float* row = rows + (first + i) * stride;
      const auto& viewpoint = viewpoints[i] = viewpoints_[vertices[first + i]];
      auto time = Clock::now();
      tally.rays += adaptive(viewpoint);
      above[i] = adaptive.above();
      visible[i] = adaptive.visible();
      adaptive.at(layout_.resolution, storedAbove, storedVisible);
      lap(time, tally.visibilitySeconds);
      transform(viewpoint.normal, viewpoint.doubleSided, above[i], visible[i], storedAbove, storedVisible, row);
      lap(time, tally.ssdfSeconds);
      texelsAbove(stored_, viewpoint.normal, cosine, storedAbove);
      fractions_(viewpoint, cosine, storedAbove, storedVisible, row + texels() + levelTexels());
      lap(time, tally.filterSeconds);
    }
    if (layout_.levels.empty()) continue;
    auto time = Clock::now();
    prefilter_(count, viewpoints, above, visible, rows + first * stride + texels(), stride, scratch);
    lap(time, tally.filterSeconds);
  }
  return tally;
}

}  // namespace chiaro
