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
      prefilter_(sampled_, layout.levels),
      fractions_(stored_, layout.directions, layout.directionSharpness) {}

TraceTally TransferRows::operator()(std::span<const std::uint32_t> vertices, float* rows, std::size_t stride) const {
  constexpr std::size_t kBatch = PrefilteredVisibility::kBatch;
  TraceTally tally;
  AlignedFloats cosine(stored_.texelCount), sampledCosine(sampled_.texelCount);
  TexelBits above[kBatch], visible[kBatch], storedAbove, storedVisible;
  Viewpoint viewpoints[kBatch];
  SsdfTransform transform(stored_);
  auto scratch = prefilter_.scratch();
  for (std::size_t first = 0; first < vertices.size(); first += kBatch) {
    const auto count = std::min(kBatch, vertices.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      float* row = rows + (first + i) * stride;
      const auto& viewpoint = viewpoints[i] = viewpoints_[vertices[first + i]];
      auto time = Clock::now();
      texelsAbove(stored_, viewpoint.normal, cosine, storedAbove);
      tally.rays += traceVisibility(rays_, stored_, viewpoint, storedAbove, storedVisible);
      above[i] = storedAbove;
      visible[i] = storedVisible;
      lap(time, tally.visibilitySeconds);
      transform(viewpoint.normal, cosine, storedAbove, storedVisible, viewpoint.doubleSided, row);
      for (std::size_t t = 0; t < stored_.texelCount; ++t) row[t] = std::clamp(row[t], -layout_.clamp, layout_.clamp);
      lap(time, tally.ssdfSeconds);
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
