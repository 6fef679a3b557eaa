#include "runtime/render/reflectance_textures.h"

#include <algorithm>

#include "assets/error.h"
#include "runtime/brdf/albedo_table.h"
#include "runtime/brdf/reflectance_table.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

/// Summed over the lobes of each texel.
std::vector<glm::vec4> albedoOf(const ReflectanceTable& table) {
  const auto layer = static_cast<std::size_t>(table.widthCount) * static_cast<std::size_t>(table.cosineCount);
  const int singles = lobe32::reflectanceSingles(table.kind), groups = singles + lobe32::reflectancePairs(table.kind);
  std::vector<glm::vec4> albedo(layer, glm::vec4(0.0f));
  for (std::size_t texel = 0; texel < layer; ++texel)
    for (int group = 0; group < groups; ++group) {
      const glm::vec4& entry = table.entries[static_cast<std::size_t>(group) * layer + texel];
      albedo[texel] += glm::vec4(entry.z, entry.w, 0, 0) * (group < singles ? 1.0f : 2.0f);
    }
  return albedo;
}

void requireTextureUnits(int most) {
  GLint units = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  if (units < most)
    throw Error(ExitCode::failed, "materials",
                "the OpenGL driver has " + std::to_string(units) + " texture units a stage, these materials take " + std::to_string(most),
                "leave CHIARO_materials_reflectance, KHR_materials_sheen, textures of specular and coat, and wetness out");
}

}  // namespace

gl::Texture makeGgxTexture() {
  const ReflectanceTable& table = reflectanceTableOf(lobe32::kGgx);
  gl::Texture texture = gl::Texture::make2dArray(GL_RGBA32F, table.widthCount, table.cosineCount, lobe32::reflectanceEntries(lobe32::kGgx));
  texture.upload(0, GL_RGBA, GL_FLOAT, table.entries.data());
  return texture;
}

gl::Texture makeSheenAlbedoTexture(const MaterialFeatures& features) {
  if (!features.sheen) return {};
  constexpr int kSize = 32;
  gl::Texture texture = gl::Texture::make2d(GL_R32F, kSize, kSize);
  texture.upload(0, GL_RED, GL_FLOAT, makeSheenAlbedoTable(kSize).data());
  return texture;
}

gl::Texture makeReflectanceTextures(const MaterialFeatures& features) {
  if (features.models != 0 || features.sheen || features.wetness || features.layerTextures) requireTextureUnits(features.wetness ? 25 : 24);
  if (features.models == 0) return {};
  gl::Texture texture;
  for (int r = 0; r < kReflectanceCount; ++r) {
    const auto model = static_cast<Reflectance>(r);
    const int place = features.tablePlace(model);
    if (place < 0) continue;
    const ReflectanceTable& table = reflectanceTableOf(lobeKindOf(model));
    if (!texture) texture = gl::Texture::make2dArray(GL_RGBA32F, table.widthCount, table.cosineCount, features.tableCount() * kReflectanceLayers);
    const auto layer = static_cast<std::size_t>(table.widthCount) * static_cast<std::size_t>(table.cosineCount);
    for (int k = 0; k + 1 < kReflectanceLayers; ++k)
      texture.uploadLayer(0, place * kReflectanceLayers + k, GL_RGBA, GL_FLOAT, table.entries.data() + static_cast<std::size_t>(k) * layer);
    texture.uploadLayer(0, place * kReflectanceLayers + kReflectanceLayers - 1, GL_RGBA, GL_FLOAT, albedoOf(table).data());
  }
  return texture;
}

}  // namespace chiaro
