#pragma once
/// Materials that change every frame: a shower that passes over the scene, puddle by puddle.

#include <string>
#include <vector>

#include "assets/scene/scene.h"
#include "runtime/render/wetness.h"

namespace chiaro {

enum class MaterialAnimation { none, wetness };

/// "none", "wetness". Throws Error (usage).
MaterialAnimation materialAnimationFromName(const std::string& name);

/// Rain from above on a scene: hollows get wet first and dry last.
class Shower {
 public:
  explicit Shower(const Scene& scene);

  /// All dry at the start, all soaked half way through a period of 4 seconds, dry at its end; smooth. The reference holds until the next call.
  const Wetness& at(double seconds);

 private:
  std::vector<float> height_;  ///< of each texel of the map: the share of all that lie lower
  Wetness wetness_;
};

}  // namespace chiaro
