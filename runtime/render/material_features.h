#pragma once
/// What the materials of a scene ask of the shaders: what none of them has is not compiled, tabulated or bound.

#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

struct MaterialFeatures {
  unsigned models = 0;         ///< bit of every Reflectance in use but GGX
  bool coat = false;
  bool sheen = false;
  bool wetness = false;        ///< Renderer::setWetness(); no material asks for it
  bool layerTextures = false;  ///< of KHR_materials_specular, _clearcoat and _sheen

  bool operator==(const MaterialFeatures&) const = default;
  /// Where the fitted table of a model starts among those of the models in use; -1 where it is not in use.
  int tablePlace(Reflectance model) const;
  int tableCount() const;
  /// For shaders/stage/shade.frag and mesh.vert. `layersEach`: of one table in their texture.
  std::vector<std::string> defines(int layersEach) const;
};

MaterialFeatures featuresOf(const std::vector<Material>& materials);
/// What either has.
MaterialFeatures merged(const MaterialFeatures& a, const MaterialFeatures& b);

/// The name of a model in shaders/lobe/ndf.glsl.
int lobeKindOf(Reflectance model);

}  // namespace chiaro
