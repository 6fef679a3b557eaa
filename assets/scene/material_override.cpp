#include "assets/scene/material_override.h"

#include <map>

#include "assets/error.h"
#include "assets/image/image.h"

namespace chiaro {
namespace {

constexpr std::size_t kRoughnessChannel = 1;  // glTF 2.0, 3.9.2: G roughness, B metallic
constexpr std::size_t kMetallicChannel = 2;

void requireUnit(const std::optional<float>& value, const char* option) {
  if (value && !(*value >= 0.0f && *value <= 1.0f)) throw usageError(option, "must lie between 0 and 1", "give a number such as 0.4");
}

/// A new texture that samples as `texture` does, from a copy of its image with `channel` at 1.
int withChannelAtOne(Scene& scene, int texture, std::size_t channel) {
  Texture copy = scene.textures[static_cast<std::size_t>(texture)];
  const EncodedImage& source = scene.images[static_cast<std::size_t>(copy.image)];
  Image8 pixels = decodeImage8(source.bytes, source.name);
  for (std::size_t i = channel; i < pixels.texels.size(); i += 4) pixels.texels[i] = 255;
  EncodedImage edited{source.name + " (override)", "image/png", encodePng(pixels)};
  copy.image = static_cast<int>(scene.images.size());
  scene.images.push_back(std::move(edited));
  scene.textures.push_back(copy);
  return static_cast<int>(scene.textures.size()) - 1;
}

}  // namespace

std::optional<Reflectance> modelFromOption(const std::string& name) {
  if (name.empty()) return std::nullopt;
  const auto model = reflectanceFromName(name);
  if (model) return model;
  throw usageError("--model", "unknown model \"" + name + "\"", "give one of " + reflectanceNameList());
}

void requireLobes(int lobes, const std::string& where) {
  if (lobes != 0 && (lobes < 0 || lobes > 9 || lobes % 2 == 0)) throw usageError(where, std::to_string(lobes) + " is not 0, 1, 3, 5, 7 or 9", "give one of them");
}

void nameDefaultMaterial(Scene& scene) {
  int added = kNone;
  for (auto& primitive : scene.primitives) {
    if (primitive.material != kNone) continue;
    if (added == kNone) {
      added = static_cast<int>(scene.materials.size());
      scene.materials.emplace_back().name = "default";
    }
    primitive.material = added;
  }
}

void overrideMaterials(Scene& scene, const MaterialOverride& values) {
  requireUnit(values.roughness, "--roughness");
  requireUnit(values.metallic, "--metallic");
  if (!values.any()) return;
  nameDefaultMaterial(scene);

  std::map<int, int> replaced;
  for (auto& material : scene.materials) {
    if (values.roughness) material.roughnessFactor = *values.roughness;
    if (values.metallic) material.metallicFactor = *values.metallic;
    if (values.model) material.reflectance = *values.model;
    if (values.roughness || values.model) material.reflectanceWidth.reset();
    if (!values.roughness && !values.metallic) continue;
    int& texture = material.metallicRoughnessTexture;
    if (texture == kNone) continue;
    if (values.roughness && values.metallic) {
      texture = kNone;
      continue;
    }
    const auto [entry, isNew] = replaced.try_emplace(texture, kNone);
    if (isNew) entry->second = withChannelAtOne(scene, texture, values.roughness ? kRoughnessChannel : kMetallicChannel);
    texture = entry->second;
  }
}

}  // namespace chiaro
