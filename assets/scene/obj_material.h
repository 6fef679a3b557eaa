#pragma once
/// Wavefront .mtl material libraries.

#include <filesystem>
#include <map>
#include <string>

#include "assets/scene/scene.h"
#include "assets/scene/warnings.h"

namespace chiaro {

/// Adds the library's materials to `scene` (Kd, Ke, d, Tr, Ns, map_Kd; textures repeat) and their indices to `byName`. Phong's
/// exponent Ns becomes alpha = sqrt(2 / (Ns + 2)). Throws Error (unreadableInput) for a texture that is missing or neither PNG nor JPEG.
void readMaterialLibrary(const std::filesystem::path& path, Warnings& warnings, Scene& scene, std::map<std::string, int>& byName);

}  // namespace chiaro
