#pragma once
/// Which stage of a bake causes which part of its error.

#include <string>
#include <vector>

#include "precompute/bake.h"
#include "precompute/report/visibility/visibility_study.h"

namespace chiaro {

/// The bake with more and more of its stages exact.
struct BudgetStage {
  std::string what;                              ///< what is still as the bake has it
  std::string cause;                             ///< of what the next stage does without; the last: what cannot be told from the truth
  ErrorBySharpness atVertices{}, inTriangles{};  ///< mean |error|
};

struct Budget {
  std::size_t vertices = 0, triangles = 0;
  double bytesPerVertex = 0.0;
  int functions = 0, clusters = 0;
  ErrorBySharpness truthNoise{};    ///< VisibilityComparison::truthNoise
  std::vector<PointError> worst;    ///< of the bake as it is: at most 12
  std::vector<BudgetStage> stages;  ///< the first: the bake as it is; the last: everything exact
};

/// Bakes in the joint form, and once more without rounding; replaces stages by exact ones one after another: rounding; shared functions and clusters; half the
/// texel size, stored and traced; maps and the half-space, by lobes traced at the vertices; interpolation, by lobes traced at the point. scene: prepared.
/// What a stage causes is its error minus the next one's, so all causes and what is left add up to the bake's error. baked: becomes the bake as it is. Throws Error.
Budget errorBudget(const Scene& scene, const BakeSettings& settings, const VisibilitySettings& measure, BakedScene& baked, const ProgressHandler& progress);

/// Error that `stage` of the budget causes.
ErrorBySharpness causedBy(const Budget& budget, std::size_t stage, ErrorBySharpness BudgetStage::*place);

}  // namespace chiaro
