#pragma once
/// Materials that change every frame: a shower that passes over the scene.

#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

enum class MaterialAnimation { none, wetness };

/// "none", "wetness". Throws Error (usage).
MaterialAnimation materialAnimationFromName(const std::string& name);

/// 0 (dry) at the start, 1 half way through a period of 4 seconds, 0 at its end; smooth.
float wetnessAt(double seconds);

/// The materials with water in and on them (after Lagarde, Water drop 3b: Physically based wet surfaces, 2013): what is not metal darkens,
/// as light that scatters below a film of water meets the surface more often, and all gets smoother. Textures go on modulating both.
std::vector<Material> wetMaterials(const std::vector<Material>& dry, float wetness);

/// Of `materials`, `seconds` after the animation began.
std::vector<Material> animated(MaterialAnimation animation, const std::vector<Material>& materials, double seconds);

}  // namespace chiaro
