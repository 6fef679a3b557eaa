#pragma once
/// Whether what an earlier bake left is part of this one.

#include <string>

#include "assets/scene/scene.h"
#include "precompute/bake.h"
#include "precompute/journal/journal.h"

namespace chiaro {

/// Of all that shapes what a bake traces and the functions made from that: the scene's surfaces, the settings (not the number of terms
/// or clusters, which come after), and `program`, the name and version of what traces. scene: prepared and refined.
Fingerprint fingerprintOf(const Scene& scene, const BakeSettings& settings, const std::string& program);

}  // namespace chiaro
