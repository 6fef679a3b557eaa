#pragma once
/// The paper's form of a bake: one PCA of all SSDFs.

#include "precompute/bake_task.h"

namespace chiaro {

/// Traces, compresses and encodes every vertex into baked.transfer (directions are set already); fills verticesResumed, raysTraced, terms,
/// seconds and error.
void bakePca(const BakeTask& task, BakedScene& baked, BakeReport& report);

}  // namespace chiaro
