#pragma once
/// Where the meshes of a scene stand at a time: its RigidMotions played.

#include <glm/glm.hpp>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// Of every mesh of Scene::meshNames, from where the scene has it: rotations and shifts, the identity of what does not move. Before a motion's first key
/// and after its last it stands as at that key.
std::vector<glm::mat4> posesAt(const Scene& scene, double seconds);

/// The last key of all motions; 0 without any.
double motionSeconds(const Scene& scene);

}  // namespace chiaro
