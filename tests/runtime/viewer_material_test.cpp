// One roughness or metalness for the whole scene, textures or not.

#include <gtest/gtest.h>

#include <limits>

#include "assets/error.h"
#include "assets/image/image.h"
#include "assets/scene/material_override.h"

namespace chiaro {
namespace {

/// Two materials that share a metallic-roughness texture of one texel (occlusion 10, roughness 20, metalness 30), one without
/// a texture, and a primitive without a material.
Scene scene() {
  Scene made;
  made.primitives.resize(2);
  made.primitives[0].material = 0;
  made.materials.resize(3);
  made.textures.resize(1);
  made.textures[0].image = 0;
  made.textures[0].wrapS = Wrap::mirroredRepeat;
  made.materials[0].metallicRoughnessTexture = 0;
  made.materials[1].metallicRoughnessTexture = 0;
  made.images.push_back({"orm", "image/png", encodePng({1, 1, {10, 20, 30, 255}})});
  return made;
}

std::vector<std::uint8_t> texelOf(const Scene& from, const Material& material) {
  const auto& texture = from.textures.at(static_cast<std::size_t>(material.metallicRoughnessTexture));
  const auto& image = from.images.at(static_cast<std::size_t>(texture.image));
  return decodeImage8(image.bytes, image.name).texels;
}

TEST(MaterialOverride, RoughnessAloneKeepsTheMetalnessOfTheTexture) {
  Scene changed = scene();
  overrideMaterials(changed, {0.25f, std::nullopt});
  for (const auto& material : changed.materials) EXPECT_EQ(material.roughnessFactor, 0.25f);
  EXPECT_EQ(changed.materials[0].metallicFactor, 1.0f);
  EXPECT_EQ(texelOf(changed, changed.materials[0]), (std::vector<std::uint8_t>{10, 255, 30, 255}));
  EXPECT_EQ(changed.materials[0].metallicRoughnessTexture, changed.materials[1].metallicRoughnessTexture) << "one copy serves both";
  EXPECT_EQ(changed.textures.back().wrapS, Wrap::mirroredRepeat);
  EXPECT_EQ(changed.images.size(), 2u);
  EXPECT_EQ(decodeImage8(changed.images[0].bytes, "").texels[1], 20) << "the file's own image stays";
}

TEST(MaterialOverride, MetalnessAloneKeepsTheRoughnessOfTheTexture) {
  Scene changed = scene();
  overrideMaterials(changed, {std::nullopt, 0.0f});
  EXPECT_EQ(changed.materials[1].metallicFactor, 0.0f);
  EXPECT_EQ(texelOf(changed, changed.materials[1]), (std::vector<std::uint8_t>{10, 20, 255, 255}));
}

TEST(MaterialOverride, BothDropTheTexture) {
  Scene changed = scene();
  overrideMaterials(changed, {0.5f, 0.5f});
  for (const auto& material : changed.materials) EXPECT_EQ(material.metallicRoughnessTexture, kNone);
  EXPECT_EQ(changed.images.size(), 1u);
}

TEST(MaterialOverride, ReachesPrimitivesWithoutAMaterial) {
  Scene changed = scene();
  overrideMaterials(changed, {0.5f, std::nullopt});
  ASSERT_EQ(changed.primitives[1].material, 3);
  EXPECT_EQ(changed.materials.at(3).roughnessFactor, 0.5f);
  EXPECT_EQ(changed.primitives[0].material, 0);
}

TEST(MaterialOverride, NothingGivenChangesNothing) {
  Scene changed = scene();
  overrideMaterials(changed, {});
  EXPECT_EQ(changed.materials.size(), 3u);
  EXPECT_EQ(changed.primitives[1].material, kNone);
  EXPECT_EQ(changed.images.size(), 1u);
}

TEST(MaterialOverride, RefusesValuesOutsideTheUnitInterval) {
  for (const float bad : {-0.01f, 1.01f, std::numeric_limits<float>::quiet_NaN()}) {
    Scene changed = scene();
    EXPECT_THROW(overrideMaterials(changed, {bad, std::nullopt}), Error);
    EXPECT_THROW(overrideMaterials(changed, {std::nullopt, bad}), Error);
  }
}

TEST(MaterialOverride, ATextureThatDoesNotDecodeIsAnInputError) {
  Scene changed = scene();
  changed.images[0].bytes.resize(20);
  EXPECT_THROW(overrideMaterials(changed, {0.5f, std::nullopt}), Error);
}

}  // namespace
}  // namespace chiaro
