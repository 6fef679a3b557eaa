/// A frame of a metal sphere: what changing materials, wetness or shape every frame adds, and what more lobes cost. Ratios are to `nothing` and `lobes/1`.

#include <benchmark/benchmark.h>

#include <epoxy/gl.h>

#include <cstdlib>

#include "assets/builtin/builtin_scene.h"
#include "assets/image/image.h"
#include "assets/scene/load_scene.h"
#include "assets/scene/vertex_cache.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/gl/context.h"
#include "runtime/render/renderer.h"
#include "tests/runtime/unoccluded.h"

namespace {

using namespace chiaro;

Material metal(float roughness, Reflectance model = Reflectance::ggx, float anisotropy = 0.0f) {
  Material m;
  m.roughnessFactor = roughness;
  m.reflectance = model;
  m.anisotropyStrength = anisotropy;
  return m;
}

/// `change` is called before every frame with its number.
void frames(benchmark::State& state, const Material& material, int lobes, const auto& change) {
  static const SgEnvironment environment = prepareEnvironment(loadEnvironment("sunny"));
  const BakedScene baked = sphereOf(material);
  const Camera camera = defaultCamera(baked.scene, 1);
  Renderer renderer(baked);
  renderer.setEnvironment(environment);
  RenderSettings settings = smallPicture(192);
  settings.lobes = lobes;
  int frame = 0;
  const auto once = [&] {
    change(renderer, frame++);
    renderer.render(camera, settings);
    glFinish();
  };
  once();  // compiles
  for (auto _ : state) once();
}

void nothing(benchmark::State& state) {
  frames(state, metal(0.4f), 0, [](Renderer&, int) {});
}

void materials(benchmark::State& state) {
  frames(state, metal(0.4f), 0, [](Renderer& renderer, int frame) {
    const float share = static_cast<float>(frame % 16) / 64.0f;
    Material m = metal(0.4f + 0.01f * share);  // another material every frame that costs the same to draw
    m.baseColorFactor = {1.0f - share, 0.9f, 0.8f, 1.0f};
    m.specularFactor = 1.0f - share;
    m.ior = 1.5f + share;
    renderer.setMaterials({m});
  });
}

void wetness(benchmark::State& state) {
  constexpr int kSize = 256;
  std::vector<Wetness> maps(16, Wetness{kSize, kSize, std::vector<std::uint8_t>(kSize * kSize, 0)});
  for (std::size_t k = 0; k < maps.size(); ++k) maps[k].texels.assign(kSize * kSize, static_cast<std::uint8_t>(k % 2));
  frames(state, metal(0.4f), 0, [&](Renderer& renderer, int frame) { renderer.setWetness(maps[static_cast<std::size_t>(frame) % maps.size()]); });
}

void shape(benchmark::State& state) {
  const Scene sphere = builtinScene("sphere");
  std::vector<PrimitiveShape> shapes[2];
  for (const float scale : {1.0f, 0.999f})
    for (std::size_t p = 0; p < sphere.primitives.size(); ++p) {
      auto& all = shapes[scale == 1.0f ? 0 : 1];
      all.push_back({p, sphere.primitives[p].positions, sphere.primitives[p].normals});
      for (auto& position : all.back().positions) position *= scale;
    }
  frames(state, metal(0.4f), 0, [&](Renderer& renderer, int frame) { renderer.setShapes(shapes[frame % 2]); });
}

/// The gallop, CHIARO_BENCH_VERTEX_FRAMES and CHIARO_BENCH_VERTEX_REST name its files: how long a frame's positions and normals take to make.
void gallop(benchmark::State& state) {
  const char *frames = std::getenv("CHIARO_BENCH_VERTEX_FRAMES"), *rest = std::getenv("CHIARO_BENCH_VERTEX_REST");
  if (frames == nullptr || rest == nullptr) return state.SkipWithError("CHIARO_BENCH_VERTEX_FRAMES and CHIARO_BENCH_VERTEX_REST name no files");
  Scene scene = loadScene(rest);
  for (auto& primitive : scene.primitives) primitive.normals.assign(primitive.positions.size(), glm::vec3(0, 1, 0));
  const VertexCache cache(scene, {frames, rest});
  double t = 0.0;
  for (auto _ : state) benchmark::DoNotOptimize(cache.at(t += 0.5));
}

void lobes(benchmark::State& state) {
  frames(state, metal(0.3f, Reflectance::beckmann), static_cast<int>(state.range(0)), [](Renderer&, int) {});
}

/// Roughness .3; the argument is the anisotropy in tenths.
void ggx(benchmark::State& state) {
  frames(state, metal(0.3f, Reflectance::ggx, 0.1f * static_cast<float>(state.range(0))), 0, [](Renderer&, int) {});
}

BENCHMARK(nothing)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(materials)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(wetness)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(shape)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(gallop)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(lobes)->Arg(1)->Arg(3)->Arg(5)->Arg(7)->Arg(9)->Arg(0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(ggx)->Arg(0)->Arg(3)->Arg(6)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  const gl::HeadlessContext context;
  std::fprintf(stderr, "drawn by %s\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  benchmark::RunSpecifiedBenchmarks();
}
