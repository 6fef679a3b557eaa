// What a vertex of a bake costs, stage by stage: one thread, the demo's scene, 64 x 64 texels.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <limits>

#include "assets/builtin/builtin_scene.h"
#include "precompute/bake.h"
#include "precompute/compression/pca.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/fractions.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {
namespace {

constexpr int kResolution = 64;
constexpr std::size_t kVertices = 256;  // evenly spaced through the scene

struct Bench {
  Bench() : scene(prepared()), rays(scene), grid(kResolution), fractions(grid, fibonacciDirections(32), 32.0f), cosine(grid.texelCount) {
    const auto all = viewpointsOf(scene, rays);
    for (std::size_t i = 0; i < kVertices; ++i) viewpoints.push_back(all[i * all.size() / kVertices]);
    for (const auto& viewpoint : viewpoints) {
      texelsAbove(grid, viewpoint.normal, cosine, above.emplace_back());
      traceVisibility(rays, grid, viewpoint, above.back(), visible.emplace_back());
    }
  }
  static Scene prepared() {
    RepairReport report;
    return prepareScene(builtinScene("ornament"), 1.0472f, report);
  }
  Scene scene;
  RayScene rays;
  OctahedralGrid grid;
  VisibleFractions fractions;
  AlignedFloats cosine;
  std::vector<Viewpoint> viewpoints;
  std::vector<TexelBits> above, visible;
};

Bench& bench() {
  static Bench instance;
  return instance;
}

void countRays(benchmark::State& state, std::uint64_t rays) {
  state.counters["Mray/s"] = benchmark::Counter(1e-6 * static_cast<double>(rays), benchmark::Counter::kIsRate);
}

void countVertices(benchmark::State& state) { state.SetItemsProcessed(state.iterations()); }

/// Embree alone, packets of a 4x4 tile.
void rawTracing(benchmark::State& state) {
  auto& b = bench();
  std::uint64_t rays = 0;
  std::size_t v = 0;
  for (auto _ : state) {
    const auto i = v++ % kVertices;
    for (std::size_t tile = 0; tile < b.grid.tileCount; ++tile) {
      const auto which = b.above[i][tile];
      if (which == 0) continue;
      benchmark::DoNotOptimize(b.rays.occluded16(b.viewpoints[i].front, b.grid.x.data() + 16 * tile, b.grid.y.data() + 16 * tile,
                                                 b.grid.z.data() + 16 * tile, which, 0.0f, std::numeric_limits<float>::infinity()));
      rays += static_cast<std::uint64_t>(__builtin_popcount(which));
    }
  }
  countRays(state, rays);
  countVertices(state);
}
BENCHMARK(rawTracing)->Unit(benchmark::kMicrosecond);

/// The same rays one by one.
void rawSingleRays(benchmark::State& state) {
  auto& b = bench();
  std::uint64_t rays = 0;
  std::size_t v = 0;
  for (auto _ : state) {
    const auto i = v++ % kVertices;
    for (std::size_t t = 0; t < b.grid.texelCount; ++t) {
      if (!texelBit(b.above[i].data(), t)) continue;
      benchmark::DoNotOptimize(b.rays.occluded(b.viewpoints[i].front, b.grid.direction(t), 0.0f, std::numeric_limits<float>::infinity()));
      ++rays;
    }
  }
  countRays(state, rays);
  countVertices(state);
}
BENCHMARK(rawSingleRays)->Unit(benchmark::kMicrosecond);

void visibility(benchmark::State& state) {
  auto& b = bench();
  std::uint64_t rays = 0;
  TexelBits above, visible;
  std::size_t v = 0;
  for (auto _ : state) {
    const auto& viewpoint = b.viewpoints[v++ % kVertices];
    texelsAbove(b.grid, viewpoint.normal, b.cosine, above);
    rays += traceVisibility(b.rays, b.grid, viewpoint, above, visible);
  }
  countRays(state, rays);
  countVertices(state);
}
BENCHMARK(visibility)->Unit(benchmark::kMicrosecond);

void visibleFractions(benchmark::State& state) {
  auto& b = bench();
  std::vector<float> fractions(32);
  std::size_t v = 0;
  for (auto _ : state) {
    const auto i = v++ % kVertices;
    b.fractions(b.viewpoints[i], b.cosine, b.above[i], b.visible[i], fractions.data());
    benchmark::DoNotOptimize(fractions.data());
  }
  countVertices(state);
}
BENCHMARK(visibleFractions)->Unit(benchmark::kMicrosecond);

void ssdf(benchmark::State& state) {
  auto& b = bench();
  SsdfTransform transform(b.grid, b.grid);
  std::vector<float> distances(b.grid.texelCount);
  TexelBits above;
  std::size_t v = 0;
  for (auto _ : state) {
    const auto i = v++ % kVertices;
    texelsAbove(b.grid, b.viewpoints[i].normal, b.cosine, above);
    transform(b.viewpoints[i].normal, b.viewpoints[i].doubleSided, above, b.visible[i], above, b.visible[i], distances.data());
    benchmark::DoNotOptimize(distances.data());
  }
  countVertices(state);
}
BENCHMARK(ssdf)->Unit(benchmark::kMicrosecond);

/// Every texel against every boundary point: what the culling saves.
void ssdfBruteForce(benchmark::State& state) {
  auto& b = bench();
  std::vector<glm::vec3> points;
  std::vector<float> chord2(b.grid.texelCount);
  std::size_t v = 0, boundary = 0;
  for (auto _ : state) {
    const auto i = v++ % kVertices;
    boundaryPoints(b.grid, b.above[i], b.visible[i], b.viewpoints[i].doubleSided, points);
    boundary += points.size();
    std::fill(chord2.begin(), chord2.end(), 4.0f);
    for (const auto& p : points)
      for (std::size_t t = 0; t < b.grid.texelCount; ++t) {
        const float dx = b.grid.x[t] - p.x, dy = b.grid.y[t] - p.y, dz = b.grid.z[t] - p.z;
        chord2[t] = std::min(chord2[t], dx * dx + dy * dy + dz * dz);
      }
    benchmark::DoNotOptimize(chord2.data());
  }
  state.counters["points"] = static_cast<double>(boundary) / static_cast<double>(state.iterations());
  countVertices(state);
}
BENCHMARK(ssdfBruteForce)->Unit(benchmark::kMicrosecond);

/// 48 terms of as many rows as given; the rate is of rows.
void compression(benchmark::State& state) {
  auto& b = bench();
  const auto rows = static_cast<std::size_t>(state.range(0));
  FixedPointMatrix matrix(rows, b.grid.texelCount, kMaxDistance);
  SsdfTransform transform(b.grid, b.grid);
  std::vector<float> distances(b.grid.texelCount);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto i = row % kVertices;
    texelsAbove(b.grid, b.viewpoints[i].normal, b.cosine, b.above[i]);
    transform(b.viewpoints[i].normal, b.viewpoints[i].doubleSided, b.above[i], b.visible[i], b.above[i], b.visible[i], distances.data());
    matrix.setRow(row, distances.data());
  }
  for (auto _ : state) benchmark::DoNotOptimize(computePca(matrix, b.grid.solidAngle, {.terms = 48, .threads = 1}));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(compression)->Arg(4096)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace chiaro

BENCHMARK_MAIN();
