#include "runtime/render/material_features.h"

#include <bit>

#include "runtime/render/frame_block.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {

int MaterialFeatures::tablePlace(Reflectance model) const {
  const unsigned bit = 1u << static_cast<unsigned>(model);
  return (models & bit) == 0 ? -1 : std::popcount(models & (bit - 1));
}

int MaterialFeatures::tableCount() const { return std::popcount(models); }

std::vector<std::string> MaterialFeatures::defines(int layersEach) const {
  // By the numbers of ndf.glsl.
  int layers[kReflectanceCount];
  for (int r = 0; r < kReflectanceCount; ++r) {
    const auto model = static_cast<Reflectance>(r);
    layers[lobeKindOf(model)] = tablePlace(model) * layersEach;
  }
  std::string list;
  for (const int layer : layers) list += (list.empty() ? "" : ", ") + std::to_string(layer);
  return {"REFLECTANCE_MODELS " + std::to_string(models != 0), "MODEL_LAYERS int[](" + list + ")", "CLEARCOAT " + std::to_string(coat), "SHEEN " + std::to_string(sheen), "WETNESS " + std::to_string(wetness),
          "MATERIAL_TEXTURES " + std::to_string(layerTextures ? kMaterialTextures : kCommonTextures)};
}

MaterialFeatures featuresOf(const std::vector<Material>& materials) {
  MaterialFeatures features;
  for (const auto& m : materials) {
    if (m.reflectance != Reflectance::ggx) features.models |= 1u << static_cast<unsigned>(m.reflectance);
    features.coat = features.coat || m.clearcoatFactor > 0.0f;
    features.sheen = features.sheen || m.sheenColorFactor != glm::vec3(0.0f);
    for (const int texture : {m.specularTexture, m.specularColorTexture, m.clearcoatTexture, m.clearcoatRoughnessTexture, m.sheenColorTexture,
                              m.sheenRoughnessTexture})
      features.layerTextures = features.layerTextures || texture != kNone;
  }
  return features;
}

MaterialFeatures merged(const MaterialFeatures& a, const MaterialFeatures& b) {
  return {a.models | b.models, a.coat || b.coat, a.sheen || b.sheen, a.wetness || b.wetness, a.layerTextures || b.layerTextures};
}

int lobeKindOf(Reflectance model) {
  switch (model) {
    case Reflectance::ggx: return lobe32::kGgx;
    case Reflectance::cookTorrance: return lobe32::kCookTorrance;
    case Reflectance::beckmann: return lobe32::kBeckmann;
    case Reflectance::blinnPhong: return lobe32::kBlinnPhong;
    case Reflectance::ward: return lobe32::kWard;
    case Reflectance::ashikhminShirley: return lobe32::kAshikhminShirley;
  }
  return lobe32::kGgx;
}

}  // namespace chiaro
