#include "precompute/bake_pca.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include "precompute/bake_error.h"
#include "precompute/compression/encode.h"
#include "precompute/compression/pca.h"
#include "precompute/elapsed.h"
#include "precompute/fraction_bytes.h"
#include "precompute/journal/row_store.h"
#include "precompute/parallel.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/fractions.h"
#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {
namespace {

/// A thread's working memory.
struct Scratch {
  explicit Scratch(const OctahedralGrid& grid) : cosine(grid.texelCount), transform(grid, grid), distances(grid.texelCount) {}
  AlignedFloats cosine;
  TexelBits above, visible;
  SsdfTransform transform;
  std::vector<float> distances;
};

/// Fills `rows` but for what an earlier bake has left in the journal.
void traceRows(const BakeTask& task, const OctahedralGrid& grid, RowStore& rows, BakedScene& baked, BakeReport& report) {
  const auto& viewpoints = task.viewpoints;
  const auto directions = static_cast<std::size_t>(baked.transfer.directionCount);
  const VisibleFractions visibleFractions(grid, baked.transfer.directions, baked.transfer.directionSharpness);
  FractionBytes fractionBytes(baked.scene, baked.transfer);
  const auto keepFractions = [&](std::size_t block, const std::uint8_t* side) {
    for (std::size_t i = 0; i < rows.rowsOf(block); ++i) fractionBytes.set(block * RowBlocks::kRows + i, side + i * directions);
  };

  const auto start = Clock::now();
  const auto progress = task.stage("visibility");
  StepCounter finished(viewpoints.size(), progress);
  const auto missing = rows.restore([&](std::size_t block, std::uint64_t rays, const std::uint8_t* side) {
    keepFractions(block, side);
    report.raysTraced += rays;
    report.verticesResumed += rows.rowsOf(block);
  });
  if (report.verticesResumed > 0) finished.add(report.verticesResumed);
  std::mutex mutex;
  double visibilityTime = 0.0, ssdfTime = 0.0;  // of all threads together
  parallelBlocks(task.settings.threads, missing.size(), [&](std::size_t m) {
    const auto block = missing[m], count = rows.rowsOf(block);
    Scratch scratch(grid);
    std::vector<float> fractions(directions);
    std::vector<std::int16_t> packed(count * grid.texelCount);
    std::vector<std::uint8_t> side(count * directions);
    std::uint64_t rayCount = 0;
    double visibilitySeconds = 0.0, ssdfSeconds = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& viewpoint = viewpoints[block * RowBlocks::kRows + i];
      const auto traceStart = Clock::now();
      texelsAbove(grid, viewpoint.normal, scratch.cosine, scratch.above);
      rayCount += traceVisibility(task.rays, grid, viewpoint, scratch.above, scratch.visible);
      visibleFractions(viewpoint, scratch.cosine, scratch.above, scratch.visible, fractions.data());
      toFractionBytes(fractions.data(), directions, side.data() + i * directions);
      const auto ssdfStart = Clock::now();
      scratch.transform(viewpoint.normal, viewpoint.doubleSided, scratch.above, scratch.visible, scratch.above, scratch.visible,
                        scratch.distances.data());
      toFixedPoint(scratch.distances.data(), grid.texelCount, kMaxDistance, packed.data() + i * grid.texelCount);
      visibilitySeconds += std::chrono::duration<double>(ssdfStart - traceStart).count();
      ssdfSeconds += secondsSince(ssdfStart);
    }
    keepFractions(block, side.data());
    rows.put(block, rayCount, packed.data(), side.data());
    const std::lock_guard lock(mutex);
    report.raysTraced += rayCount;
    visibilityTime += visibilitySeconds;
    ssdfTime += ssdfSeconds;
    finished.add(count);
  });
  const double wall = secondsSince(start), all = std::max(visibilityTime + ssdfTime, 1e-9);
  report.seconds.visibility = wall * visibilityTime / all;
  report.seconds.ssdf = wall * ssdfTime / all;
}

}  // namespace

void bakePca(const BakeTask& task, BakedScene& baked, BakeReport& report) {
  const auto& settings = task.settings;
  auto& transfer = baked.transfer;
  const OctahedralGrid grid(settings.resolution);
  const auto count = task.viewpoints.size(), directions = static_cast<std::size_t>(settings.directionCount);
  const PcaSettings pcaSettings{.terms = settings.terms, .seed = settings.seed, .threads = settings.threads};

  // Components, weights as floats and as they are stored; a thread's block as it is traced, checked and written.
  const auto threads = static_cast<std::size_t>(threadCount(settings.threads));
  const auto working = pcaMemory(count, grid.texelCount, pcaSettings) + 8 * static_cast<std::size_t>(settings.terms) * grid.texelCount +
                       2 * count * static_cast<std::size_t>(settings.terms) + count * (directions + 8) + threads * 8 * RowBlocks::kRows * grid.texelCount;
  const bool inMemory = task.journal == nullptr || task.memory.fits(working + 2 * count * grid.texelCount);
  task.memory.require(working + (inMemory ? 2 * count * grid.texelCount : 0));

  RowStore ssdf(count, grid.texelCount, directions,
                {.journal = task.journal, .kind = static_cast<std::uint32_t>(BakeRecord::pcaRows), .inMemory = inMemory});
  traceRows(task, grid, ssdf, baked, report);

  const auto compressionStart = Clock::now();
  const auto pca = computePca(ssdf, kMaxDistance, grid.rowMajorSolidAngle(), pcaSettings, task.stage("compression"));
  encodePca(pca, baked.scene, transfer);
  report.seconds.compression = secondsSince(compressionStart);

  report.terms = transfer.terms;
  report.bytesPerVertex = transfer.bytesPerVertex(count);
  const TracedSignal signal{.grid = &grid, .rays = &task.rays, .viewpoints = &task.viewpoints, .ssdf = &ssdf, .step = kMaxDistance / 32767.0f};
  report.error = measureBakeError(signal, pca, transfer, settings, task.stage("error"));
}

}  // namespace chiaro
