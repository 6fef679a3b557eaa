#pragma once
/// The first animation of a glTF file as the motions of its meshes (glTF 2.0, 3.11 and appendix C).

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "assets/scene/gltf_accessor.h"
#include "assets/scene/gltf_library.h"
#include "assets/scene/scene.h"
#include "assets/scene/warnings.h"

namespace chiaro {

glm::dmat4 localTransform(const tinygltf::Node& node);

/// A mesh of the scene, and the nodes from a root to the one that shows it.
struct MeshNodes {
  int mesh = 0;
  std::string label;
  std::vector<int> path;
};

/// Keys are those of the file, and as many between them as keep what lies between two (curves, chains of nodes, steps) to a thirtieth of a second. What moves other
/// than as a rigid body is left at rest with a warning, as are morphs, cameras and lights. Throws Error (input) for what is damaged.
std::vector<RigidMotion> readGltfMotions(const tinygltf::Model& model, const GltfAccessors& accessors, const std::vector<MeshNodes>& meshes, const std::string& where,
                                         Warnings& warnings);

}  // namespace chiaro
