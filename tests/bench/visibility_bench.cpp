// Adaptive visibility and the distance transform against tracing every direction: one thread, 256 vertices spread over a scene.
// CHIARO_BENCH_SCENE: a file or builtin:NAME, else builtin:ornament.
#include <benchmark/benchmark.h>

#include <bit>
#include <cstdlib>
#include <string>

#include "assets/builtin/builtin_scene.h"
#include "assets/scene/load_scene.h"
#include "precompute/bake.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/adaptive_visibility.h"

namespace chiaro {
namespace {

constexpr std::size_t kVertices = 256;

struct Bench {
  Bench() : scene(prepared()), rays(scene) {
    const auto all = viewpointsOf(scene, rays);
    for (std::size_t i = 0; i < kVertices; ++i) viewpoints.push_back(all[i * all.size() / kVertices]);
  }
  static Scene prepared() {
    const char* given = std::getenv("CHIARO_BENCH_SCENE");
    const std::string name = given != nullptr ? given : "builtin:ornament";
    RepairReport report;
    return prepareScene(isBuiltinName(name) ? builtinScene(name.substr(std::string("builtin:").size())) : loadScene(name), 1.0472f, report);
  }
  Scene scene;
  RayScene rays;
  std::vector<Viewpoint> viewpoints;
};

Bench& bench() {
  static Bench instance;
  return instance;
}

/// All vertices each iteration, so that every run is of the same ones; times are of all of them.
void traced(benchmark::State& state, int coarse, int sampling) {
  auto& b = bench();
  const AdaptiveSphere sphere(coarse, sampling);
  AdaptiveVisibility visibility(b.rays, sphere);
  std::uint64_t rays = 0;
  for (auto _ : state)
    for (const auto& viewpoint : b.viewpoints) rays += visibility(viewpoint);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVertices));
  state.counters["Mray/s"] = benchmark::Counter(1e-6 * static_cast<double>(rays), benchmark::Counter::kIsRate);
  state.counters["rays"] = static_cast<double>(rays) / static_cast<double>(state.iterations()) / kVertices;
}

/// Every direction above the horizon, packets of a 4x4 tile.
void raw(benchmark::State& state) {
  const auto resolution = static_cast<int>(state.range(0));
  traced(state, resolution, resolution);
}
BENCHMARK(raw)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

void adaptive(benchmark::State& state) {
  auto& b = bench();
  const auto coarse = static_cast<int>(state.range(0)), sampling = static_cast<int>(state.range(1));
  traced(state, coarse, sampling);
  const AdaptiveSphere sphere(coarse, sampling), fullSphere(sampling, sampling);
  AdaptiveVisibility some(b.rays, sphere), all(b.rays, fullSphere);
  std::uint64_t different = 0, someRays = 0, allRays = 0;
  for (const auto& viewpoint : b.viewpoints) {
    someRays += some(viewpoint);
    allRays += all(viewpoint);
    for (std::size_t tile = 0; tile < all.visible().size(); ++tile)
      different += static_cast<std::uint64_t>(std::popcount(static_cast<unsigned>(all.visible()[tile] ^ some.visible()[tile])));
  }
  state.counters["ray_share"] = static_cast<double>(someRays) / static_cast<double>(allRays);
  state.counters["different"] = static_cast<double>(different) / (kVertices * static_cast<double>(sampling) * sampling);
}
BENCHMARK(adaptive)->Args({32, 64})->Args({32, 128})->Args({32, 256})->Args({64, 256})->Args({128, 256})->Args({32, 512})->Unit(benchmark::kMillisecond);

/// Sampling and storage at the first resolution; the clamp is the second, degrees.
void transform(benchmark::State& state) {
  auto& b = bench();
  const auto resolution = static_cast<int>(state.range(0));
  const AdaptiveSphere sphere(32, resolution);
  const OctahedralGrid grid(resolution);
  SsdfTransform ssdf(grid, grid, static_cast<float>(state.range(1)) * kMaxDistance / 90.0f);
  AdaptiveVisibility visibility(b.rays, sphere);
  std::vector<TexelBits> above, visible;
  for (const auto& viewpoint : b.viewpoints) {
    visibility(viewpoint);
    above.push_back(visibility.above());
    visible.push_back(visibility.visible());
  }
  std::vector<float> distances(grid.texelCount);
  for (auto _ : state)
    for (std::size_t i = 0; i < kVertices; ++i) {
      ssdf(b.viewpoints[i].normal, b.viewpoints[i].doubleSided, above[i], visible[i], above[i], visible[i], distances.data());
      benchmark::DoNotOptimize(distances.data());
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVertices));
}
BENCHMARK(transform)->ArgsProduct({{64, 128, 256}, {90, 30}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace chiaro

BENCHMARK_MAIN();
