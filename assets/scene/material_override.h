#pragma once
/// One roughness or metalness for a whole scene, whatever its textures say: to compare renderers over a range of materials.

#include <optional>

#include "assets/scene/scene.h"

namespace chiaro {

struct MaterialOverride {
  std::optional<float> roughness;  ///< perceptual, 0..1
  std::optional<float> metallic;   ///< 0..1
  std::optional<Reflectance> model = std::nullopt;

  bool any() const { return roughness.has_value() || metallic.has_value() || model.has_value(); }
};

/// What --model names, nothing for an empty text. Throws Error (usage).
std::optional<Reflectance> modelFromOption(const std::string& name);
/// How many SG lobes a material may be drawn with: 0 (the best known), 1, 3, 5, 7 or 9. `where` names the setting in an Error (usage).
void requireLobes(int lobes, const std::string& where);

/// Gives every primitive without a material the glTF default one as a material of the scene, so that it can be edited.
void nameDefaultMaterial(Scene& scene);

/// Sets the values on every material (and on primitives without one). A roughness or a model takes the place of CHIARO_materials_reflectance's
/// width. A metallic-roughness texture is dropped when both are
/// given; when one is, the texture is replaced by a copy whose overridden channel is 1, so that the other keeps its detail.
/// Throws Error (usage) for a value outside 0..1, Error (unreadableInput) for a texture that does not decode.
void overrideMaterials(Scene& scene, const MaterialOverride& values);

}  // namespace chiaro
