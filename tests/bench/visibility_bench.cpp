// Adaptive visibility and the distance transform against tracing every direction: one thread, 256 vertices spread over a scene.
// CHIARO_BENCH_SCENE: a file or builtin:NAME, else builtin:ornament.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <string>
#include <vector>

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

/// Rays from one origin, 16 a packet but for the last; padded.
struct Packets {
  glm::vec3 origin;
  AlignedFloats x, y, z;
  std::size_t rays;
};

/// The texels beside a pair that differs, of one side of the horizon of a map: board by board, which is the order of adaptive tracing too.
Packets edgesOf(const SphereBoards& boards, const std::vector<Board>& side, const std::vector<Board>& visible, glm::vec3 origin,
                Board which) {
  std::vector<Board> seen(boards.boardCount), hidden(boards.boardCount);
  for (std::size_t b = 0; b < boards.boardCount; ++b) {
    seen[b] = visible[b] & side[b];
    hidden[b] = ~visible[b] & side[b];
  }
  std::vector<std::size_t> texels;
  for (std::size_t b = 0; b < boards.boardCount; ++b) {
    const auto edge = (seen[b] & boards.around4(hidden.data(), b)) | (hidden[b] & boards.around4(seen.data(), b));
    for (auto left = edge & which; left != 0; left &= left - 1)
      texels.push_back(64 * b + static_cast<std::size_t>(std::countr_zero(left)));
  }
  const auto size = (texels.size() + 15) / 16 * 16;
  Packets result{origin, AlignedFloats(size), AlignedFloats(size), AlignedFloats(size), texels.size()};
  for (std::size_t i = 0; i < texels.size(); ++i) {
    result.x[i] = boards.x[texels[i]];
    result.y[i] = boards.y[texels[i]];
    result.z[i] = boards.z[texels[i]];
  }
  return result;
}

/// What no method that traces both texels of every pair that differs can beat: those of the fully traced map are known beforehand, and
/// nothing but their rays is timed. Second argument 2: every other one of them, as on a chessboard.
void edges(benchmark::State& state) {
  auto& b = bench();
  const auto resolution = static_cast<int>(state.range(0));
  const Board which = state.range(1) == 2 ? 0xa5a5a5a5a5a5a5a5u : ~Board{0};
  const AdaptiveSphere sphere(resolution, resolution);
  const auto& boards = sphere.levels.back();
  AdaptiveVisibility visibility(b.rays, sphere);
  std::vector<Packets> all;
  std::vector<Board> side, visible;
  std::size_t rays = 0;
  for (const auto& viewpoint : b.viewpoints) {
    visibility(viewpoint);
    boards.fromTexels(visibility.above(), side);
    boards.fromTexels(visibility.visible(), visible);
    all.push_back(edgesOf(boards, side, visible, viewpoint.front, which));
    rays += all.back().rays;
    if (!viewpoint.doubleSided) continue;
    for (auto& bits : side) bits = ~bits;
    all.push_back(edgesOf(boards, side, visible, viewpoint.back, which));
    rays += all.back().rays;
  }
  OcclusionPacket packet(b.rays);
  for (auto _ : state)
    for (const auto& packets : all) {
      packet.setOrigin(packets.origin);
      for (std::size_t i = 0; i < packets.rays; i += 16) {
        const auto count = std::min<std::size_t>(packets.rays - i, 16);
        benchmark::DoNotOptimize(packet(packets.x.data() + i, packets.y.data() + i, packets.z.data() + i, (1u << count) - 1u));
      }
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVertices));
  state.counters["rays"] = static_cast<double>(rays) / kVertices;
}
BENCHMARK(edges)->Args({256, 1})->Args({256, 2})->Unit(benchmark::kMillisecond);

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
