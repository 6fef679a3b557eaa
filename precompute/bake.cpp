#include "precompute/bake.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <numbers>
#include <string>

#include "assets/error.h"
#include "precompute/bake_clustered.h"
#include "precompute/bake_error.h"
#include "precompute/compression/encode.h"
#include "precompute/compression/pca.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/parallel.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/adaptive_visibility.h"
#include "precompute/visibility/fractions.h"
#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/viewpoints.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void requireRange(const std::string& name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  const auto text = [](double x) { return std::to_string(static_cast<long long>(x)); };
  throw usageError(name, "is out of range", "give a value from " + text(least) + " to " + text(most));
}

void requireValid(const BakeSettings& settings) {
  requireRange("resolution", settings.resolution, 16, 256);
  requireRange("terms", settings.terms, 1, 256);
  requireRange("directions", settings.directionCount, 8, 64);
  if (settings.resolution % 4 != 0) throw usageError("resolution", "is not a multiple of 4", "use 32, 64, 128, ...");
  if (settings.directionCount % 4 != 0) throw usageError("directions", "is not a multiple of 4", "use 16, 32, 64, ...");
  if (!(settings.directionSharpness > 0.0f)) throw usageError("direction sharpness", "is not positive", "use 32");
  if (settings.compression == Compression::pca) return;
  requireRange("clusters", settings.clusters, 0, 4096);
  requireRange("functions", settings.functions, 0, 1024);
  if (settings.resolution % 8 != 0) throw usageError("resolution", "is not a multiple of 8", "use 32, 64, 128, ...");
  const int times = settings.samplingResolution / settings.resolution;
  if (settings.samplingResolution > 1024 || times < 1 || (times & (times - 1)) != 0 || times * settings.resolution != settings.samplingResolution)
    throw usageError("sample resolution", "is not the resolution times a power of two, 1024 at most", "use 64, 128 or 256 with 64");
  if (settings.weightBits != 8 && settings.weightBits != 16) throw usageError("weight bits", "are neither 8 nor 16", "use 8");
  if (settings.wideTerms < 0 || settings.wideTerms > 256) throw usageError("wide terms", "must lie between 0 and 256", "use 1");
  if (!std::isfinite(settings.bytesPerVertex)) throw usageError("bytes a vertex", "are not a number", "use 104");
  const int bits = settings.functionBits;
  if (bits != 0 && bits != 4 && bits != 8 && bits != 16) throw usageError("function bits", "are none of 0, 4, 8 and 16", "use 0");
}

/// A promise that the finest texels cannot keep is refused.
void requireLeastOccluder(const BakeSettings& settings) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double degrees = kDegrees * static_cast<double>(settings.leastOccluder);
  if (!(degrees >= 0.0 && degrees <= 90.0)) throw usageError("least occluder", "is out of range", "give 0 (off) to 90 degrees");
  if (degrees == 0.0) return;
  const double least = 2.0 * kDegrees * coveringRadius(settings.samplingResolution);
  if (degrees >= least) return;
  char remedy[96];
  std::snprintf(remedy, sizeof remedy, "give at least %.3f degrees, or a larger sample resolution", std::ceil(1000.0 * least) / 1000.0);
  throw usageError("least occluder", "is narrower than " + std::to_string(settings.samplingResolution) + " texels a side are sure to meet", remedy);
}

/// What the first stage leaves behind for every vertex of the scene.
struct Traced {
  FixedPointMatrix ssdf;                 ///< #vertices by #texels
  std::vector<std::uint8_t> fractions;   ///< #vertices by #directions
  std::uint64_t rays = 0;
  double visibilitySeconds = 0.0, ssdfSeconds = 0.0;
};

/// A thread's working memory.
struct Scratch {
  explicit Scratch(const OctahedralGrid& grid) : cosine(grid.texelCount), transform(grid, grid), distances(grid.texelCount) {}
  AlignedFloats cosine;
  TexelBits above, visible;
  SsdfTransform transform;
  std::vector<float> distances;
};

Traced traceScene(const RayScene& rays, const OctahedralGrid& grid, const std::vector<Viewpoint>& viewpoints,
                  const VisibleFractions& visibleFractions, const BakeSettings& settings, const std::function<void(double)>& progress) {
  constexpr std::size_t kBlock = 32;
  const auto directionCount = static_cast<std::size_t>(settings.directionCount);
  Traced traced;
  traced.ssdf = FixedPointMatrix(viewpoints.size(), grid.texelCount, kMaxDistance);
  traced.fractions.resize(viewpoints.size() * directionCount);

  const auto start = Clock::now();
  StepCounter finished(viewpoints.size(), progress);
  std::mutex mutex;
  double visibilityTime = 0.0, ssdfTime = 0.0;  // of all threads together
  parallelBlocks(settings.threads, (viewpoints.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    Scratch scratch(grid);
    std::vector<float> fractions(directionCount);
    std::uint64_t rayCount = 0;
    double visibilitySeconds = 0.0, ssdfSeconds = 0.0;
    const auto end = std::min((block + 1) * kBlock, viewpoints.size());
    for (std::size_t v = block * kBlock; v < end; ++v) {
      const auto& viewpoint = viewpoints[v];
      const auto traceStart = Clock::now();
      texelsAbove(grid, viewpoint.normal, scratch.cosine, scratch.above);
      rayCount += traceVisibility(rays, grid, viewpoint, scratch.above, scratch.visible);
      visibleFractions(viewpoint, scratch.cosine, scratch.above, scratch.visible, fractions.data());
      for (std::size_t j = 0; j < directionCount; ++j)
        traced.fractions[v * directionCount + j] = static_cast<std::uint8_t>(std::lrint(255.0f * fractions[j]));
      const auto ssdfStart = Clock::now();
      scratch.transform(viewpoint.normal, viewpoint.doubleSided, scratch.above, scratch.visible, scratch.above, scratch.visible,
                        scratch.distances.data());
      traced.ssdf.setRow(v, scratch.distances.data());
      visibilitySeconds += std::chrono::duration<double>(ssdfStart - traceStart).count();
      ssdfSeconds += secondsSince(ssdfStart);
    }
    {
      const std::lock_guard lock(mutex);
      traced.rays += rayCount;
      visibilityTime += visibilitySeconds;
      ssdfTime += ssdfSeconds;
    }
    finished.add(end - block * kBlock);
  });
  const double wall = secondsSince(start);
  traced.visibilitySeconds = wall * visibilityTime / (visibilityTime + ssdfTime);
  traced.ssdfSeconds = wall * ssdfTime / (visibilityTime + ssdfTime);
  return traced;
}

void storeFractions(const Traced& traced, const Scene& scene, Transfer& transfer) {
  transfer.primitives.resize(scene.primitives.size());
  auto next = traced.fractions.begin();
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const auto count = static_cast<std::ptrdiff_t>(scene.primitives[p].positions.size()) * transfer.directionCount;
    transfer.primitives[p].visibility.assign(next, next + count);
    next += count;
  }
}

/// What the file says about its making. No times: the same bake gives the same bytes.
TransferFacts factsOf(const BakeSettings& settings, const BakeReport& report) {
  TransferFacts facts{
      {"settings.resolution", settings.resolution},
      {"settings.sample_resolution", settings.samplingResolution},
      {"settings.least_occluder", static_cast<double>(settings.leastOccluder)},
      {"settings.terms", settings.terms},
      {"settings.directions", settings.directionCount},
      {"settings.direction_sharpness", static_cast<double>(settings.directionSharpness)},
      {"settings.crease_angle", static_cast<double>(settings.creaseAngle)},
      {"settings.refine", static_cast<double>(settings.refine.error)},
      {"settings.seed", settings.seed},
      {"rays_traced", static_cast<double>(report.raysTraced)},
  };
  if (settings.compression != Compression::pca) {
    facts["settings.clusters"] = settings.clusters;
    facts["settings.functions"] = settings.functions;
    facts["settings.weight_bits"] = settings.weightBits;
    facts["settings.function_bits"] = settings.functionBits;
    facts["settings.wide_terms"] = settings.wideTerms;
    facts["settings.bytes_per_vertex"] = settings.bytesPerVertex;
  }
  for (const auto& [name, value] : report.error) facts["error." + name] = value;
  return facts;
}

}  // namespace

BakeSettings resolvedSettings(const BakeSettings& given) {
  BakeSettings settings = given;
  const bool global = settings.compression == Compression::pca;
  if (settings.terms == 0) settings.terms = global ? 48 : 24;
  if (global) settings.samplingResolution = settings.resolution;
  if (settings.samplingResolution == 0) {
    settings.samplingResolution = settings.resolution;
    for (int i = 0; i < 2 && 2 * settings.samplingResolution <= 256; ++i) settings.samplingResolution *= 2;
  }
  requireValid(settings);
  requireLeastOccluder(settings);
  return settings;
}

BakedScene bake(const Scene& scene, const BakeSettings& given, BakeReport& report, const ProgressHandler& progress) {
  const auto settings = resolvedSettings(given);
  const auto start = Clock::now();
  const auto stage = [&](const std::string& name) {
    return [&progress, name](double done) {
      if (progress) progress(name, done);
    };
  };
  report = {};
  BakedScene baked;
  baked.scene = prepareScene(scene, settings.creaseAngle, report.repairs);
  if (baked.scene.triangleCount() == 0) throw inputError("scene", "has no triangle with an area", "give a file with a surface in it");
  if (settings.refine.error != 0.0f)
    baked.scene = refineScene(std::move(baked.scene), settings.refine, settings.threads, report.refinement, stage("refinement"));
  report.vertices = baked.scene.vertexCount();
  report.triangles = baked.scene.triangleCount();

  const RayScene rays(baked.scene);
  const OctahedralGrid grid(settings.resolution);
  auto& transfer = baked.transfer;
  transfer.resolution = settings.resolution;
  transfer.directionCount = settings.directionCount;
  transfer.directionSharpness = settings.directionSharpness;
  transfer.directions = fibonacciDirections(settings.directionCount);

  const auto viewpoints = viewpointsOf(baked.scene, rays);
  if (settings.compression != Compression::pca) {
    bakeClustered(rays, viewpoints, settings, baked, report, stage);
    baked.facts = factsOf(settings, report);
    report.seconds.total = secondsSince(start);
    return baked;
  }
  const VisibleFractions visibleFractions(grid, transfer.directions, settings.directionSharpness);
  const auto traced = traceScene(rays, grid, viewpoints, visibleFractions, settings, stage("visibility"));
  storeFractions(traced, baked.scene, transfer);
  report.raysTraced = traced.rays;
  report.seconds.visibility = traced.visibilitySeconds;
  report.seconds.ssdf = traced.ssdfSeconds;

  const auto compressionStart = Clock::now();
  std::vector<float> columnWeight(grid.texelCount);
  for (std::size_t t = 0; t < grid.texelCount; ++t) columnWeight[grid.rowMajor[t]] = grid.solidAngle[t];
  const PcaSettings pcaSettings{.terms = settings.terms, .seed = settings.seed, .threads = settings.threads};
  const auto pca = computePca(traced.ssdf, columnWeight, pcaSettings, stage("compression"));
  encodePca(pca, baked.scene, transfer);
  report.seconds.compression = secondsSince(compressionStart);

  const TracedSignal signal{.grid = &grid, .rays = &rays, .viewpoints = &viewpoints, .ssdf = &traced.ssdf};
  report.terms = transfer.terms;
  report.bytesPerVertex = transfer.bytesPerVertex(report.vertices);
  report.error = measureBakeError(signal, pca, transfer, settings, stage("error"));
  baked.facts = factsOf(settings, report);
  report.seconds.total = secondsSince(start);
  return baked;
}

}  // namespace chiaro
