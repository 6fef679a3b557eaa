#include "assets/scene/material_replacement.h"

#include <algorithm>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/gltf_scene.h"

namespace chiaro {
namespace {

Material onlyMaterial(const std::filesystem::path& file, const WarningHandler& warn) {
  const Scene source = readGltfScene(readFile(file), file, warn);
  if (source.materials.empty()) throw inputError(file.string(), "has no material", "make one with chiaro-precompute material");
  if (!source.textures.empty())
    throw inputError(file.string(), "has textures, which cannot be put on another mesh", "name a material of plain factors");
  return source.materials.front();
}

std::string namesOf(const Scene& scene) {
  std::string names;
  for (const auto& material : scene.materials) names += (names.empty() ? "" : ", ") + material.name;
  return names.empty() ? "the scene has no materials" : "it has " + names;
}

}  // namespace

void replaceMaterial(Scene& scene, const std::string& name, const std::filesystem::path& file, const WarningHandler& warn) {
  const Material source = onlyMaterial(file, warn);
  bool found = false;
  for (Material& material : scene.materials) {
    if (material.name != name) continue;
    found = true;
    Material replaced = source;
    replaced.name = material.name;
    replaced.normalTexture = material.normalTexture;
    replaced.normalTransform = material.normalTransform;
    replaced.normalScale = material.normalScale;
    replaced.alphaMode = material.alphaMode;
    replaced.alphaCutoff = material.alphaCutoff;
    replaced.doubleSided = material.doubleSided;
    material = std::move(replaced);
  }
  if (!found) throw usageError("--material", "the scene has no material \"" + name + "\"", namesOf(scene));
}

}  // namespace chiaro
