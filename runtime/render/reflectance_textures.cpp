#include "runtime/render/reflectance_textures.h"

#include <algorithm>

#include "assets/error.h"
#include "runtime/brdf/reflectance_table.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr int kSingles = 5, kPairs = 2;
static_assert(kReflectanceLayers == lobe32::kReflectanceEntries + 1);
static_assert(kSingles + 2 * kPairs == lobe32::kReflectanceLobes);

/// Summed over the lobes of each texel.
std::vector<glm::vec4> albedoOf(const ReflectanceTable& table) {
  const auto layer = static_cast<std::size_t>(table.widthCount) * static_cast<std::size_t>(table.cosineCount);
  std::vector<glm::vec4> albedo(layer, glm::vec4(0.0f));
  for (std::size_t texel = 0; texel < layer; ++texel)
    for (std::size_t group = 0; group < kSingles + kPairs; ++group) {
      const glm::vec4& entry = table.entries[group * layer + texel];
      albedo[texel] += glm::vec4(entry.z, entry.w, 0, 0) * (group < kSingles ? 1.0f : 2.0f);
    }
  return albedo;
}

void requireTextureUnits() {
  GLint units = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  if (units < 21)
    throw Error(ExitCode::failed, "materials", "the OpenGL driver has " + std::to_string(units) + " texture units a stage, these materials take 21",
                "leave CHIARO_materials_reflectance and textures of specular and coat out");
}

}  // namespace

gl::Texture makeReflectanceTextures(const MaterialFeatures& features) {
  if (features.models != 0 || features.layerTextures) requireTextureUnits();
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
