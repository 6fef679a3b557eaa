#pragma once
/// A material of a file of its own in place of one of a scene: a measured one, for example.

#include <filesystem>
#include <string>

#include "assets/scene/load_scene.h"
#include "assets/scene/scene.h"

namespace chiaro {

/// Every material of the scene called `name` becomes the first one of the glTF file, which needs no meshes. Its name, normal map, opacity and
/// sides stay the scene's. `warn` as for loadScene. Throws Error (usage) when the scene has no such material, (unreadableInput) when the file
/// cannot be read, has no material, or one with textures.
void replaceMaterial(Scene& scene, const std::string& name, const std::filesystem::path& file, const WarningHandler& warn = {});

}  // namespace chiaro
