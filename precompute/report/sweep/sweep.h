#pragma once
/// Bakes and measures the points of a sweep that are not known yet.

#include "precompute/bake.h"
#include "precompute/report/sweep/sweep_bakes.h"
#include "precompute/report/sweep/sweep_pictures.h"
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
/// prepareScene() leaves it. bakes: where the points' bakes come from; they are forgotten once measured. pictures: null where nothing is drawn.
std::vector<SweepResult> sweep(const Scene& scene, const std::vector<SweepPoint>& points, const VisibilitySettings& measure, SweepStore& store, SweepBakes& bakes,
                               SweepPictures* pictures, SweepScene& facts, const ProgressHandler& progress);

/// The place of the best of `results` that is a bake and within both targets (absent: no limit): with a target error the one of fewest bytes, else of the least picture's
/// error; then of the least frame time. error: the largest at vertices over the sharpnesses. Nothing where none is within them.
std::optional<std::size_t> choose(const std::vector<SweepResult>& results, std::optional<double> targetError, std::optional<double> targetFrameMilliseconds);
/// The commands that make and draw it.
std::string commandsOf(const SweepPoint& point, const std::string& scene);

}  // namespace chiaro
