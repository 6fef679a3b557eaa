#include "assets/scene/moving_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "assets/error.h"

namespace chiaro {

MovingMesh::MovingMesh(const Scene& scene, const std::string& mesh, const std::string& option) : count_(scene.meshNames.size()) {
  const auto found = std::find(scene.meshNames.begin(), scene.meshNames.end(), mesh);
  if (found == scene.meshNames.end()) {
    std::string names;
    for (const auto& name : scene.meshNames) names += (names.empty() ? "" : ", ") + name;
    throw usageError(option, "the scene has no mesh \"" + mesh + "\"", names.empty() ? "leave it out" : "give one of: " + names);
  }
  mesh_ = static_cast<std::size_t>(found - scene.meshNames.begin());
  Scene part;
  for (const auto& primitive : scene.primitives)
    if (static_cast<std::size_t>(primitive.mesh) == mesh_) part.primitives.push_back(primitive);
  middle_ = boundsOf(part).center();
}

std::vector<glm::mat4> MovingMesh::poses(double degrees) const {
  std::vector<glm::mat4> all(count_, glm::mat4(1.0f));
  const auto radians = static_cast<float>(std::remainder(degrees, 360.0) * std::numbers::pi / 180.0);
  all[mesh_] = glm::translate(glm::mat4(1.0f), middle_) * glm::rotate(glm::mat4(1.0f), radians, glm::vec3(0, 1, 0)) * glm::translate(glm::mat4(1.0f), -middle_);
  return all;
}

}  // namespace chiaro
