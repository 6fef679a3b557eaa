#include "precompute/report/sweep/sweep.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <tuple>

#include "precompute/journal/fingerprint.h"
#include "precompute/report/visibility/haar_method.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/report/visibility/sh_method.h"
#include "precompute/report/visibility/transfer_method.h"
#include "precompute/report/visibility/visibility_study.h"

namespace chiaro {
namespace {

// Shares of a point's time, for its progress: a bake up to the end of its tracing, and all of it. The rest is measured.
constexpr double kTracing = 0.6, kBaking = 0.9;

SweepFigures measured(const VisibilityStudy& study, const VisibilityMethod& method, const ProgressHandler& progress) {
  const auto error = study.errorsOf({&method}, progress).front();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {.bytesPerVertex = error.bytesPerVertex, .seconds = kNone, .cpuSeconds = kNone, .atVertices = error.atVertices, .inTriangles = error.inTriangles};
}

std::unique_ptr<VisibilityMethod> makeBaseline(const SweepPoint& point, const VisibilityStudy& study) {
  VisibilityInput input = study.input();
  input.resolution = point.resolution;
  input.terms = point.terms;
  if (point.form == SweepForm::haar) return std::move(makeHaarMethods(input, {point.terms}).front());
  if (point.form == SweepForm::sphericalHarmonics) {
    int bands = 1;
    while (bands * bands < point.terms) ++bands;
    return std::move(makeShMethods(input, {bands}).front());
  }
  const OctahedralGrid grid(point.resolution);
  const TracedVertices traced(input, grid);
  return makePcaMethod(input, traced, ssdfWithHorizon());
}

Compression compressionOf(SweepForm form) {
  if (form == SweepForm::pca) return Compression::pca;
  return form == SweepForm::clustered ? Compression::clustered : Compression::joint;
}

}  // namespace

BakeSettings bakeSettingsOf(const SweepPoint& point, const VisibilitySettings& measure) {
  BakeSettings settings{.compression = compressionOf(point.form),
                        .resolution = point.resolution,
                        .samplingResolution = point.samplingResolution,
                        .terms = point.terms,
                        .bytesPerVertex = point.bytes,
                        .seed = measure.seed,
                        .threads = measure.threads};
  if (point.weightBits != 0) settings.weightBits = point.weightBits;
  settings.functionBits = point.functionBits;
  settings.clusters = point.clusters;
  return settings;
}

std::string sweepKey(const Scene& scene, const VisibilitySettings& measure, const std::string& program) {
  const auto fingerprint = fingerprintOf(scene, resolvedSettings({}), program);
  char text[160];
  std::snprintf(text, sizeof text, "%016llx%016llx %d vertices, %d points, %d rays, basis %d, seed %u", static_cast<unsigned long long>(fingerprint[0]),
                static_cast<unsigned long long>(fingerprint[1]), measure.vertices, measure.points, measure.rays, measure.basisVertices, measure.seed);
  return text;
}

std::vector<SweepResult> sweep(const Scene& scene, const std::vector<SweepPoint>& points, const VisibilitySettings& measure, SweepStore& store, SweepBakes& bakes,
                               SweepPictures* pictures, SweepScene& facts, const ProgressHandler& progress) {
  facts = {.vertices = scene.vertexCount(), .triangles = scene.triangleCount(), .resumed = 0};
  std::vector<SweepResult> results;
  std::optional<VisibilityStudy> study;  // where all is known nothing is traced
  std::optional<std::pair<SweepPoint, SweepFigures>> baked;  // the bake that was measured last, and what all its points share
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    if (const auto known = store.find(point)) {
      results.push_back(*known);
      ++facts.resumed;
      continue;
    }
    if (!study) study.emplace(scene, measure, progress);
    const auto name = std::to_string(i + 1) + " of " + std::to_string(points.size()) + ", " + labelOf(point);
    double shown = 0.0;
    const ProgressHandler stage = [&](const std::string& what, double done) {
      shown = std::max(shown, what == "visibility" ? kTracing * done : what == "lobes" ? kBaking + (1.0 - kBaking) * done : 0.0);
      if (progress) progress(name, shown);
    };
    SweepResult result{.point = point, .figures = {}};
    if (point.isBake()) {
      if (!baked || !(baked->first == bakeOf(point))) {
        const auto& made = bakes.get(point, stage);
        auto figures = measured(*study, *makeTransferMethod(made.baked.transfer), stage);
        figures.seconds = made.seconds;
        figures.cpuSeconds = made.cpuSeconds;
        baked.emplace(bakeOf(point), figures);
        if (pictures != nullptr) pictures->open(made.baked);
      }
      result.figures = baked->second;
      if (pictures != nullptr) pictures->measure(point, result.figures, stage);
    } else {
      stage("visibility", 0.0);
      const auto method = makeBaseline(point, *study);
      result.figures = measured(*study, *method, stage);
    }
    store.append(result);
    results.push_back(result);
    if (point.isBake() && (i + 1 == points.size() || !(bakeOf(points[i + 1]) == bakeOf(point)))) bakes.forget(point);
  }
  return results;
}

std::optional<std::size_t> choose(const std::vector<SweepResult>& results, std::optional<double> targetError, std::optional<double> targetFrameMilliseconds) {
  std::optional<std::size_t> best;
  const auto cost = [&](const SweepResult& result) {
    const auto& figures = result.figures;
    return std::tuple(targetError ? figures.bytesPerVertex : figures.pictureRmse, figures.frameMilliseconds, figures.bytesPerVertex);
  };
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& figures = results[i].figures;
    if (!results[i].point.isBake()) continue;
    if (targetError && !(SweepFigures::worst(figures.atVertices) <= *targetError)) continue;
    if (targetFrameMilliseconds && !(figures.frameMilliseconds <= *targetFrameMilliseconds)) continue;
    if (!best || cost(results[i]) < cost(results[*best])) best = i;
  }
  return best;
}

std::string commandsOf(const SweepPoint& point, const std::string& scene) {
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return std::string(text);
  };
  std::string text = "chiaro-precompute " + scene + " -o baked.glb --compression " + nameOf(point.form) + " --resolution " + number(point.resolution);
  const auto add = [&](const char* option, double value, double usual) {
    if (value != usual) text += std::string(" ") + option + " " + number(value);
  };
  add("--sample-resolution", point.samplingResolution, 0);
  add("--terms", point.terms, 0);
  add("--bytes", point.bytes, 0);
  add("--weight-bits", point.weightBits == 0 ? 8 : point.weightBits, 8);
  add("--function-bits", point.functionBits, 0);
  add("--clusters", point.clusters, 0);
  text += "\nchiaro-view baked.glb";
  add("--lobes", point.lobes, 0);
  add("--prefilter", point.prefilter == 0 ? 512 : point.prefilter, 512);
  return text;
}

}  // namespace chiaro
