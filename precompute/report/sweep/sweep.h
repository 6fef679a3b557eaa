#pragma once
/// Bakes and measures the points of a sweep that are not known yet.

#include "precompute/bake.h"
#include "precompute/report/sweep/sweep_store.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace chiaro {

/// Of a point that is a bake.
BakeSettings bakeSettingsOf(const SweepPoint& point, const VisibilitySettings& measure);

/// What the figures of a point depend on beside its own settings: the scene's surfaces, the program and how it is measured. scene: prepared.
std::string sweepKey(const Scene& scene, const VisibilitySettings& measure, const std::string& program);

struct SweepScene {
  std::size_t vertices = 0, triangles = 0;
  std::size_t resumed = 0;  ///< points that were in the store already
};

/// Results of all `points` in their order. Every point is in `store` as soon as it is finished; what is there already is not measured again. scene: as
/// prepareScene() leaves it. Bakes use all threads, one after another.
std::vector<SweepResult> sweep(const Scene& scene, const std::vector<SweepPoint>& points, const VisibilitySettings& measure, SweepStore& store,
                               SweepScene& facts, const ProgressHandler& progress);

}  // namespace chiaro
