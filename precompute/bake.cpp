#include "precompute/bake.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "assets/error.h"
#include "precompute/bake_clustered.h"
#include "precompute/bake_pca.h"
#include "precompute/bake_task.h"
#include "precompute/elapsed.h"
#include "precompute/journal/fingerprint.h"
#include "precompute/visibility/adaptive_visibility.h"
#include "precompute/visibility/fractions.h"

namespace chiaro {
namespace {

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
  if (settings.compression == Compression::pca) {
    if (settings.targetError != 0.0 || settings.bytesPerVertex != 0.0)
      throw usageError("compression", "pca goes by its terms, not by bytes or an error", "use clustered or joint, or give terms alone");
    return;
  }
  requireRange("clusters", settings.clusters, 0, 4096);
  requireRange("functions", settings.functions, 0, 1024);
  if (settings.resolution % 8 != 0) throw usageError("resolution", "is not a multiple of 8", "use 32, 64, 128, ...");
  const int times = settings.samplingResolution / settings.resolution;
  if (settings.samplingResolution > 1024 || times < 1 || (times & (times - 1)) != 0 || times * settings.resolution != settings.samplingResolution)
    throw usageError("sample resolution", "is not the resolution times a power of two, 1024 at most", "use 64, 128 or 256 with 64");
  if (settings.weightBits != 8 && settings.weightBits != 16) throw usageError("weight bits", "are neither 8 nor 16", "use 8");
  if (!std::isfinite(settings.bytesPerVertex)) throw usageError("bytes a vertex", "are not a number", "use 104");
  if (!(settings.targetError >= 0.0 && settings.targetError < 1.0)) throw usageError("target error", "must lie between 0 and 1", "use 0.02");
  if (settings.targetError > 0.0 && (settings.bytesPerVertex != 0.0 || settings.functions != 0 || settings.clusters != 0))
    throw usageError("target error", "chooses bytes, functions and clusters, and one of these is given too", "give one or the other");
  const int bits = settings.functionBits;
  if (bits != 0 && bits != 4 && bits != 8 && bits != 16) throw usageError("function bits", "are none of 0, 4, 8 and 16", "use 0");
}

/// The journal that this bake goes on from, or a new one.
std::unique_ptr<Journal> openJournal(const Scene& scene, const BakeSettings& settings, const BakeStorage& storage) {
  if (storage.journal.empty()) return nullptr;
  auto journal = std::make_unique<Journal>(storage.journal, fingerprintOf(scene, settings, storage.program), storage.fresh);
  if (!storage.notice) return journal;
  if (journal->found() == Journal::Found::same) storage.notice(storage.journal.string() + ": goes on from what an earlier bake has finished");
  if (journal->found() == Journal::Found::other)
    storage.notice(storage.journal.string() + ": is of another scene, other settings or another build of this program: starts anew");
  return journal;
}

/// A promise that the finest texels cannot keep is refused.
void requireLeastOccluder(const BakeSettings& settings) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double degrees = kDegrees * static_cast<double>(settings.leastOccluder);
  if (!(degrees >= 0.0 && settings.leastOccluder <= std::numbers::pi_v<float> / 2.0f)) throw usageError("least occluder", "is out of range", "give 0 (off) to 90 degrees");
  if (degrees == 0.0) return;
  const double least = 2.0 * kDegrees * coveringRadius(settings.samplingResolution);
  if (degrees >= least) return;
  char remedy[96];
  std::snprintf(remedy, sizeof remedy, "give at least %.3f degrees, or a larger sample resolution", std::ceil(1000.0 * least) / 1000.0);
  throw usageError("least occluder", "is narrower than " + std::to_string(settings.samplingResolution) + " texels a side are sure to meet", remedy);
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
    facts["settings.bytes_per_vertex"] = settings.bytesPerVertex;
    facts["settings.target_error"] = settings.targetError;
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

BakedScene bake(Scene scene, const BakeSettings& given, BakeReport& report, const ProgressHandler& progress, const BakeStorage& storage) {
  const auto settings = resolvedSettings(given);
  const auto start = Clock::now();
  const auto stage = [&](const std::string& name) {
    return [&progress, name](double done) {
      if (progress) progress(name, done);
    };
  };
  report = {};
  BakedScene baked;
  baked.scene = prepareScene(std::move(scene), settings.creaseAngle, report.repairs);
  if (baked.scene.triangleCount() == 0) throw inputError("scene", "has no triangle with an area", "give a file with a surface in it");
  if (settings.refine.error != 0.0f)
    baked.scene = refineScene(std::move(baked.scene), settings.refine, settings.threads, report.refinement, stage("refinement"));
  report.vertices = baked.scene.vertexCount();
  report.triangles = baked.scene.triangleCount();

  auto& transfer = baked.transfer;
  transfer.resolution = settings.resolution;
  transfer.directionCount = settings.directionCount;
  transfer.directionSharpness = settings.directionSharpness;
  transfer.directions = fibonacciDirections(settings.directionCount);

  const auto journal = openJournal(baked.scene, settings, storage);
  const RayScene rays(baked.scene);
  const auto viewpoints = viewpointsOf(baked.scene, rays);
  giveBackFreedMemory();
  const BakeTask task{.rays = rays,
                      .viewpoints = viewpoints,
                      .settings = settings,
                      .journal = journal.get(),
                      .memory = MemoryBudget(storage.memoryLimit),
                      .stage = stage};
  if (settings.compression == Compression::pca)
    bakePca(task, baked, report);
  else
    bakeClustered(task, baked, report);
  baked.facts = factsOf(settings, report);
  report.seconds.total = secondsSince(start);
  return baked;
}

}  // namespace chiaro
