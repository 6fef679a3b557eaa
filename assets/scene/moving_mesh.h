#pragma once
/// A mesh of a scene that turns about +Y through its middle.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

class MovingMesh {
 public:
  /// `mesh` is one of Scene::meshNames. Throws Error (usage), whose `where` is `option`, and names them where it is none.
  MovingMesh(const Scene& scene, const std::string& mesh, const std::string& option = "--moving");

  /// Of every mesh of the scene, from where it stands in the file; the others rest. Rotations and shifts.
  std::vector<glm::mat4> poses(double degrees) const;

 private:
  std::size_t mesh_ = 0, count_ = 0;
  glm::vec3 middle_{0.0f};
};

}  // namespace chiaro
