#pragma once
/// The clustered forms of a bake: vertices stream through, only a sample of their rows is ever held at once.

#include "precompute/bake_task.h"

namespace chiaro {

/// Traces, compresses and encodes every vertex into baked.transfer (directions are set already); fills verticesResumed, raysTraced, terms,
/// seconds and error.
void bakeClustered(const BakeTask& task, BakedScene& baked, BakeReport& report);

}  // namespace chiaro
