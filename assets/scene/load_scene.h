#pragma once
/// Scenes from files: glTF 2.0 (.gltf, .glb) and the mesh formats OBJ, PLY, OFF and STL.

#include <filesystem>
#include <functional>
#include <string>

#include "assets/scene/scene.h"

namespace chiaro {

/// Called with one line for each thing in the file that is carried no further (an unknown extension, TEXCOORD_1, ...).
using WarningHandler = std::function<void(const std::string&)>;

/// Reads a scene by its file extension (case ignored). Node transforms are applied; triangle strips and fans become lists;
/// lines and points are dropped with a warning. Mesh formats give one primitive with the default material
/// (base colour .8, roughness .5, not metallic), positions unwelded as the file has them, normals only if the file has them.
/// Throws Error (unreadableInput) on anything missing, truncated, out of range or not finite.
Scene loadScene(const std::filesystem::path& path, const WarningHandler& warn = {});

}  // namespace chiaro
