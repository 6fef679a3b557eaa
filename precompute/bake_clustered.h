#pragma once
/// The clustered forms of a bake: vertices stream through, only a sample of their rows is ever held at once.

#include <functional>
#include <string>
#include <vector>

#include "precompute/bake.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/visibility/viewpoints.h"

namespace chiaro {

/// Traces, compresses and encodes every vertex into baked.transfer (directions are set already); fills raysTraced, terms, seconds and error.
void bakeClustered(const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const BakeSettings& settings, BakedScene& baked,
                   BakeReport& report, const std::function<std::function<void(double)>(const std::string&)>& stage);

}  // namespace chiaro
