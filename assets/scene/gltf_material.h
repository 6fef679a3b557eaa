#pragma once
/// Materials, textures and images of a glTF file.

#include <filesystem>
#include <string>
#include <vector>

#include "assets/scene/gltf_accessor.h"
#include "assets/scene/gltf_library.h"
#include "assets/scene/scene.h"
#include "assets/scene/warnings.h"

namespace chiaro {

/// What the file held for each image before anything was decoded; empty where it must still be fetched.
using ImageBytes = std::vector<std::vector<std::uint8_t>>;

/// Fills scene.images, textures and materials. Factors out of range are clamped with a warning.
/// Throws Error (unreadableInput) on an index out of range, a missing image, or one that is neither PNG nor JPEG.
void readGltfMaterials(const tinygltf::Model& model, const GltfAccessors& accessors, ImageBytes images,
                       const std::filesystem::path& path, Warnings& warnings, Scene& scene);

/// A number in a JSON object, or `fallback`.
double gltfNumber(const tinygltf::Value& object, const std::string& key, double fallback);

}  // namespace chiaro
