#include "precompute/report/budget/budget.h"

#include "precompute/report/budget/exact_methods.h"
#include "precompute/report/visibility/transfer_method.h"
#include "precompute/row_layout.h"

namespace chiaro {
namespace {

constexpr std::size_t kWorstPoints = 12;

BakedScene bakeStage(const Scene& scene, const BakeSettings& settings, const std::string& name, const ProgressHandler& progress) {
  BakeReport report;
  return bake(scene, settings, report, [&](const std::string& stage, double done) {
    if (progress) progress(name + ": " + stage, done);
  });
}

/// The same functions and clusters, as many terms, every number as fine as the form allows.
BakeSettings withoutRounding(BakeSettings settings, const Transfer& transfer) {
  settings.functions = static_cast<int>(transfer.clustered.functions.count());
  settings.clusters = static_cast<int>(transfer.clustered.clusters.size());
  settings.bytesPerVertex = -1.0;
  settings.weightBits = 16;
  settings.functionBits = 16;
  return settings;
}

/// Half the texel size of every map and of what is traced.
TransferRows::Layout finer(TransferRows::Layout layout) {
  layout.resolution *= 2;
  layout.samplingResolution *= 2;
  for (auto& level : layout.levels) level.resolution *= 2;
  return layout;
}

}  // namespace

Budget errorBudget(const Scene& scene, const BakeSettings& given, const VisibilitySettings& measure, BakedScene& baked, const ProgressHandler& progress) {
  const auto settings = resolvedSettings(given);
  const VisibilityStudy study(scene, measure, progress);
  const auto& input = study.input();
  baked = bakeStage(scene, settings, "bake", progress);
  const auto& transfer = baked.transfer;
  Budget budget{.vertices = scene.vertexCount(), .triangles = scene.triangleCount(), .bytesPerVertex = 0.0, .functions = static_cast<int>(transfer.clustered.functions.count()),
                .clusters = static_cast<int>(transfer.clustered.clusters.size()), .truthNoise = study.facts().truthNoise, .worst = {}, .stages = {}};
  const auto add = [&](const VisibilityMethod& method, const std::string& what, const std::string& cause) {
    const auto error = study.errorsOf({&method}, progress).front();
    if (budget.stages.empty()) budget.bytesPerVertex = error.bytesPerVertex;
    budget.stages.push_back({.what = what, .cause = cause, .atVertices = error.atVertices, .inTriangles = error.inTriangles});
  };
  const auto asBaked = makeTransferMethod(transfer);
  add(*asBaked, "the bake", "rounding");
  budget.worst = study.worstPoints(*asBaked, kWorstPoints, progress);
  {
    const auto exact = bakeStage(scene, withoutRounding(settings, transfer), "bake without rounding", progress);
    add(*makeTransferMethod(exact.transfer), "without rounding", "functions and clusters");
  }
  const auto layout = rowLayout(settings, transfer.directions, transfer.directionSharpness);
  add(*makeRowsMethod(input, layout, "rows"), "without compression", "texel size");
  add(*makeRowsMethod(input, finer(layout), "finer rows"), "texels half as wide", "half-space and maps");
  add(*makeTracedCornersMethod(input), "lobes traced at vertices", "interpolation");
  add(*makeTracedPointMethod(input), "lobes traced at the point", "left: noise of the rays");
  return budget;
}

ErrorBySharpness causedBy(const Budget& budget, std::size_t stage, ErrorBySharpness BudgetStage::*place) {
  ErrorBySharpness part = budget.stages[stage].*place;
  if (stage + 1 < budget.stages.size())
    for (std::size_t s = 0; s < part.size(); ++s) part[s] -= (budget.stages[stage + 1].*place)[s];
  return part;
}

}  // namespace chiaro
