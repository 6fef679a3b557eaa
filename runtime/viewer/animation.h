#pragma once
/// What changes every frame: a shower that passes over the scene, puddle by puddle; meshes that move.

#include <optional>
#include <string>
#include <vector>

#include "assets/scene/moving_mesh.h"
#include "assets/scene/scene.h"
#include "assets/scene/vertex_cache.h"
#include "runtime/render/renderer.h"
#include "runtime/render/wetness.h"

namespace chiaro {

/// wetness: a Shower. scene: the scene's own motions (assets/scene/motion.h), over and over.
enum class Animation { none, wetness, scene };

/// "none", "wetness", "scene". Throws Error (usage).
Animation animationFromName(const std::string& name);

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

/// One of the above, a mesh that turns 30 degrees a second where one is named, and one that changes shape 30 times a second where frames are.
class Animator {
 public:
  /// Throws Error (usage) for a scene without motions of its own that is to play them, and for a mesh that it has not.
  Animator(const Scene& scene, Animation animation, const std::string& moving, const VertexCacheFiles& shapes = {});

  bool moves() const { return shower_ || moving_ || shapes_ || !played_.motions.empty(); }
  void apply(Renderer& renderer, double seconds);

 private:
  std::optional<Shower> shower_;
  std::optional<MovingMesh> moving_;
  std::optional<VertexCache> shapes_;
  Scene played_;  // names of meshes and motions, nothing else
};

}  // namespace chiaro
