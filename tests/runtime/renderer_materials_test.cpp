// Reflectance models, coats and multiple scattering in the renderer, beside brute force on an unoccluded sphere.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "assets/builtin/builtin_scene.h"
#include "assets/error.h"
#include "assets/image/image.h"
#include "precompute/reference/reference.h"
#include "runtime/render/material_features.h"
#include "runtime/render/renderer.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/runtime/unoccluded.h"

namespace chiaro {
namespace {

constexpr int kSize = 48;

Material metal(float roughness, Reflectance model = Reflectance::ggx) {
  Material m;
  m.roughnessFactor = roughness;
  m.baseColorFactor = glm::vec4(0.9f, 0.7f, 0.5f, 1.0f);
  m.reflectance = model;
  return m;
}

RenderSettings settingsFor(bool compensated) {
  RenderSettings settings = smallPicture(kSize);
  settings.energyCompensation = compensated;
  return settings;
}

ImageRgba drawn(Renderer& renderer, const Camera& camera, bool compensated = false) {
  renderer.render(camera, settingsFor(compensated));
  return renderer.readRadiance();
}

/// Tone-mapped PSNR of object pixels, in dB.
double psnr(const ImageRgba& picture, const BakedScene& baked, const Environment& environment, const Camera& camera, bool compensated = false) {
  ReferenceSettings settings;
  settings.width = settings.height = kSize;
  settings.samplesPerPixel = 256;
  settings.background = false;
  settings.energyCompensation = compensated;
  const ImageRgba truth = renderReference(baked.scene, environment, camera, settings).radiance;
  const float exposure = autoExposure(environment);
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < truth.texels.size(); ++i) {
    if (!(truth.texels[i].a > 0.99f && picture.texels[i].a > 0.99f)) continue;
    const glm::vec3 d = displayColor(glm::vec3(picture.texels[i]), exposure, ToneMap::neutral) - displayColor(glm::vec3(truth.texels[i]), exposure, ToneMap::neutral);
    squares += glm::dot(d, d);
    count += 3;
  }
  return count > 500 ? 10 * std::log10(count / squares) : 0.0;
}

struct Light {
  Environment environment = loadEnvironment("sunny");
  SgEnvironment prepared = prepareEnvironment(environment);
};
const Light& sunny() {
  static const Light light;
  return light;
}

void expectClose(const std::string& what, const Material& material, double least, bool compensated = false) {
  const BakedScene baked = sphereOf(material);
  const Camera camera = defaultCamera(baked.scene, 1);
  Renderer renderer(baked);
  renderer.setEnvironment(sunny().prepared);
  const ImageRgba picture = drawn(renderer, camera, compensated);
  for (const auto& texel : picture.texels)
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(texel[c] >= 0.0f && texel[c] <= 1e7f) << what << ' ' << texel[c];
  const double got = psnr(picture, baked, sunny().environment, camera, compensated);
  std::printf("%s: %.1f dB\n", what.c_str(), got);
  EXPECT_GE(got, least) << what;
  EXPECT_NO_THROW(testContext().debugLog().requireClean(what));
}

// Limits a few dB under what is measured: a broken table, frame or Fresnel term costs ten and more.
TEST(RendererMaterials, RoundModels) {
  expectClose("Beckmann .3", metal(0.3f, Reflectance::beckmann), 36);
  expectClose("Beckmann .8", metal(0.8f, Reflectance::beckmann), 36);
  Material phong = metal(1.0f, Reflectance::blinnPhong);
  phong.reflectanceWidth = {{200.0f, 200.0f}};
  phong.reflectanceF0 = {{0.3f, 0.6f, 0.9f}};
  expectClose("Blinn-Phong 200 of given F0", phong, 36);
}

// The sun's streak, the albedo of each view and the strings of lobes for all else: each alone costs ten and more where it is off.
TEST(RendererMaterials, BrushedGgx) {
  for (const auto& [roughness, anisotropy] : {std::pair{0.3f, 0.6f}, {0.15f, 0.5f}, {0.4f, 1.0f}}) {
    Material brushed = metal(roughness);
    brushed.anisotropyStrength = anisotropy;
    expectClose("brushed GGX " + std::to_string(roughness) + ' ' + std::to_string(anisotropy), brushed, 37);
  }
}

// A map of one wetness is a material that darkens and gets smoother; one of two is either, side by side.
TEST(RendererMaterials, WetnessByTheTexel) {
  Material dry = metal(0.6f);
  dry.metallicFactor = 0.25f;
  Material wet = dry;
  wet.roughnessFactor *= 0.35f;
  wet.baseColorFactor = glm::vec4(glm::vec3(dry.baseColorFactor) * (1.0f - 0.6f * 0.75f), 1.0f);
  const BakedScene baked = sphereOf(dry);
  const Camera camera = defaultCamera(baked.scene, 1);
  Renderer renderer(baked);
  renderer.setEnvironment(sunny().prepared);
  const ImageRgba plain = drawn(renderer, camera);
  const auto apart = [](const ImageRgba& a, const ImageRgba& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i)
      for (int c = 0; c < 3; ++c)
        most = std::max(most, static_cast<double>(std::abs(a.texels[i][c] - b.texels[i][c]) / (0.01f + std::abs(b.texels[i][c]))));
    return most;
  };
  renderer.setMaterials({wet});
  const ImageRgba expected = drawn(renderer, camera);
  ASSERT_GT(apart(expected, plain), 0.1);
  renderer.setMaterials({dry});
  renderer.setWetness({1, 1, {0}});
  EXPECT_LE(apart(drawn(renderer, camera), plain), 1e-5);
  renderer.setWetness({1, 1, {255}});
  const ImageRgba soaked = drawn(renderer, camera);
  EXPECT_LE(apart(soaked, expected), 1e-3);  // the same numbers, multiplied in another order

  // Half of the sphere: every pixel but those of the middle is one or the other.
  Wetness halves{64, 1, std::vector<std::uint8_t>(64, 0)};
  std::fill(halves.texels.begin() + 32, halves.texels.end(), std::uint8_t{255});
  const float size = 2.0f * boundsOf(baked.scene).diagonal();
  const glm::vec3 right = glm::vec3(camera.worldFromCamera[0]) / size;
  halves.s = glm::vec4(right, 0.5f - glm::dot(right, boundsOf(baked.scene).center()));
  renderer.setWetness(halves);
  const ImageRgba both = drawn(renderer, camera);
  int likeDry = 0, likeWet = 0, neither = 0;
  for (std::size_t i = 0; i < both.texels.size(); ++i) {
    if (!(both.texels[i].a > 0.99f)) continue;
    const float toDry = glm::length(both.texels[i] - plain.texels[i]), toWet = glm::length(both.texels[i] - soaked.texels[i]);
    if (toDry <= 1e-5f * glm::length(plain.texels[i])) ++likeDry;
    else if (toWet <= 1e-5f * glm::length(soaked.texels[i])) ++likeWet;
    else ++neither;
  }
  EXPECT_GT(likeDry, 300);
  EXPECT_GT(likeWet, 300);
  EXPECT_LT(neither, 200);

  EXPECT_THROW(renderer.setWetness({2, 2, {0, 1, 2}}), Error);
  EXPECT_NO_THROW(testContext().debugLog().requireClean("wetness"));
}

TEST(RendererMaterials, ElongatedModels) {
  Material brushed = metal(1.0f, Reflectance::ward);
  brushed.reflectanceWidth = {{0.3f, 0.1f}};
  expectClose("Ward .3, .1", brushed, 28);
  brushed.reflectance = Reflectance::ashikhminShirley;
  brushed.reflectanceWidth = {{40.0f, 400.0f}};
  brushed.anisotropyRotation = 0.7f;
  expectClose("Ashikhmin-Shirley 40, 400, turned", brushed, 28);
}

TEST(RendererMaterials, CoatSpecularAndIor) {
  Material coated = metal(0.6f);
  coated.metallicFactor = 0.0f;
  coated.clearcoatFactor = 1.0f;
  coated.clearcoatRoughness = 0.15f;
  coated.emissiveFactor = glm::vec3(0.2f, 0.0f, 0.1f);
  expectClose("coat", coated, 34);
  Material tinted = metal(0.3f);
  tinted.metallicFactor = 0.0f;
  tinted.ior = 2.2f;
  tinted.specularFactor = 0.7f;
  tinted.specularColorFactor = {1.0f, 0.3f, 2.0f};
  expectClose("specular", tinted, 34);
}

// Fuzz over a base, its albedo taken from what lies below.
TEST(RendererMaterials, Sheen) {
  for (const float roughness : {0.2f, 0.5f, 1.0f}) {
    Material cloth = metal(0.7f);
    cloth.metallicFactor = 0.0f;
    cloth.baseColorFactor = {0.1f, 0.05f, 0.2f, 1.0f};
    cloth.sheenColorFactor = {0.9f, 0.6f, 0.4f};
    cloth.sheenRoughness = roughness;
    expectClose("sheen " + std::to_string(roughness), cloth, 34);
  }
}

// What no material has is not compiled.
TEST(RendererMaterials, SheenIsCompiledOnlyWhereThereIsOne) {
  Material plain = metal(0.5f), cloth = plain;
  cloth.sheenColorFactor = glm::vec3(0.5f);
  const auto has = [](const Material& m, const std::string& define) {
    const auto defines = featuresOf({m}).defines(9);
    return std::find(defines.begin(), defines.end(), define) != defines.end();
  };
  EXPECT_TRUE(has(plain, "SHEEN 0"));
  EXPECT_TRUE(has(cloth, "SHEEN 1"));
  EXPECT_TRUE(has(cloth, "CLEARCOAT 0"));
}

// Every texture of the new extensions, each with a value of its own in the channel that counts.
TEST(RendererMaterials, LayerTexturesMatchTheReference) {
  Material m = metal(0.5f);
  m.metallicFactor = 0.0f;
  m.specularTexture = m.specularColorTexture = m.clearcoatTexture = m.clearcoatRoughnessTexture = m.sheenColorTexture = m.sheenRoughnessTexture = 0;
  m.sheenColorFactor = {0.3f, 0.6f, 0.9f};
  m.sheenRoughness = 0.8f;
  m.ior = 2.0f;
  m.clearcoatFactor = 1.0f;
  m.clearcoatRoughness = 0.5f;
  BakedScene baked = sphereOf(m);
  baked.scene.images = {{"layers", "image/png", encodePng({1, 1, {200, 100, 50, 128}})}};
  baked.scene.textures = {{0, Wrap::repeat, Wrap::repeat, false}};
  const Camera camera = defaultCamera(baked.scene, 1);
  Renderer renderer(baked);
  renderer.setEnvironment(sunny().prepared);
  const double got = psnr(drawn(renderer, camera), baked, sunny().environment, camera);
  std::printf("layer textures: %.1f dB\n", got);
  EXPECT_GE(got, 34);
}

// A white metal of GGX in a white furnace: all comes back once multiple scattering is put in, at every roughness (.03: the table of albedos is
// interpolated at grazing views).
TEST(RendererMaterials, CompensationClosesTheFurnace) {
  const SgEnvironment white = prepareEnvironment(loadEnvironment("white"));
  for (const float roughness : {0.2f, 0.55f, 1.0f}) {
    Material m = metal(roughness);
    m.baseColorFactor = glm::vec4(1.0f);
    const BakedScene baked = sphereOf(m);
    Renderer renderer(baked);
    renderer.setEnvironment(white);
    for (const auto& texel : drawn(renderer, defaultCamera(baked.scene, 1), true).texels)
      if (texel.a > 0.99f) {
        EXPECT_NEAR(texel.g, 1.0f, 0.03f) << roughness;
      }
  }
  expectClose("compensated GGX 1", metal(1.0f), 36, true);
}

// Materials that change: a model and a coat that no material had before are built when they come, and what went is as it was.
TEST(RendererMaterials, MayChangeToAnyModel) {
  const BakedScene plain = sphereOf(metal(0.4f));
  const Camera camera = defaultCamera(plain.scene, 1);
  Renderer renderer(plain);
  renderer.setEnvironment(sunny().prepared);
  const ImageRgba before = drawn(renderer, camera);
  Material other = metal(0.3f, Reflectance::beckmann);
  other.clearcoatFactor = 0.5f;
  renderer.setMaterials({other});
  const ImageRgba changed = drawn(renderer, camera);
  EXPECT_GE(psnr(changed, sphereOf(other), sunny().environment, camera), 34);
  renderer.setMaterials(plain.scene.materials);
  const ImageRgba after = drawn(renderer, camera);
  for (std::size_t i = 0; i < before.texels.size(); ++i) EXPECT_LE(glm::length(before.texels[i] - after.texels[i]), 1e-4f * (1.0f + glm::length(before.texels[i])));
}

TEST(RendererMaterials, AnyNumberOfLobes) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked);
  renderer.setEnvironment(sunny().prepared);
  RenderSettings settings = settingsFor(false);
  for (const int lobes : {1, 9}) {
    settings.lobes = lobes;
    renderer.render(defaultCamera(baked.scene, 1), settings);
    for (const auto& texel : renderer.readRadiance().texels) EXPECT_TRUE(texel.g >= 0.0f && texel.g <= 1e7f) << lobes;
  }
  settings.lobes = 4;
  EXPECT_ANY_THROW(renderer.render(defaultCamera(baked.scene, 1), settings));
}

}  // namespace
}  // namespace chiaro
