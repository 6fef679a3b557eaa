// Pictures of the renderer. Where the truth is known in closed form it is used; else brute force, on a scene without any transfer
// error, so that a bound speaks of the shading alone. tests/programs compares whole scenes.
#include "runtime/render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "assets/builtin/builtin_scene.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/runtime/unoccluded.h"
#ifdef CHIARO_WITH_REFERENCE
#include "precompute/reference/reference.h"
#endif

namespace chiaro {
namespace {

Material material(float roughness, float metallic, glm::vec3 color, float anisotropy = 0.0f) {
  Material m;
  m.roughnessFactor = roughness;
  m.metallicFactor = metallic;
  m.baseColorFactor = glm::vec4(color, 1.0f);
  m.anisotropyStrength = anisotropy;
  return m;
}

int covered(const ImageRgba& image) {
  int count = 0;
  for (const auto& texel : image.texels) count += texel.a > 0.99f;
  return count;
}

// Under radiance 1 from everywhere a white metal reflects its directional albedo: single scattering loses energy when rough, never gains.
// A white dielectric of the glTF model does gain at grazing angles (its diffuse part gives up the cosine-weighted mean of the Fresnel
// term, the reflection adds its value at that view); its own bound is .96 + 1.
TEST(Renderer, WhiteFurnace) {
  const SgEnvironment white = prepareEnvironment(loadEnvironment("white"));
  for (const float metallic : {0.0f, 1.0f}) {
    for (const float roughness : {0.0f, 0.2f, 0.5f, 0.55f, 1.0f}) {
      const BakedScene baked = sphereOf(material(roughness, metallic, glm::vec3(1)));
      Renderer renderer(baked);
      renderer.setEnvironment(white);
      renderer.render(defaultCamera(baked.scene, 1), smallPicture(32));
      const ImageRgba image = renderer.readRadiance();
      EXPECT_GE(covered(image), 100);
      for (const auto& texel : image.texels) {
        if (!(texel.a > 0.99f)) continue;
        // 2 %: interpolation of the albedo table at grazing angles.
        EXPECT_LE(texel.g, metallic > 0.5f ? 1.02f : 1.96f) << roughness << " " << metallic;
        EXPECT_GE(texel.g, roughness < 0.3f ? 0.9f : 0.25f) << roughness << " " << metallic;
      }
    }
  }
}

// With every visible fraction 0 nothing diffuse is left; shadows off brings it all back.
TEST(Renderer, ShadowsDarkenAndCanBeTurnedOff) {
  Scene scene = builtinScene("sphere");
  scene.materials = {material(1, 0, glm::vec3(0.5f))};
  for (auto& primitive : scene.primitives) primitive.material = 0;
  const BakedScene hidden = unoccluded(scene, 0);
  Renderer renderer(hidden);
  renderer.setEnvironment(prepareEnvironment(loadEnvironment("overcast")));
  RenderSettings settings = smallPicture(32);
  renderer.render(defaultCamera(scene, 1), settings);
  const ImageRgba dark = renderer.readRadiance();
  settings.shadows = false;
  renderer.render(defaultCamera(scene, 1), settings);
  const ImageRgba lit = renderer.readRadiance();
  for (std::size_t i = 0; i < dark.texels.size(); ++i) {
    if (!(lit.texels[i].a > 0.99f)) continue;
    EXPECT_LE(dark.texels[i].g, 1e-3f);
    EXPECT_GE(lit.texels[i].g, 0.05f);
  }
}

// Debug views are data: the light's exposure and tone map must not change them, nor the background stand behind them.
TEST(Renderer, DebugViewsShowTheirValues) {
  const BakedScene baked = sphereOf(material(0.5f, 0, glm::vec3(0.5f)));
  Renderer renderer(baked);
  renderer.setEnvironment(prepareEnvironment(loadEnvironment("white")));
  RenderSettings settings = smallPicture(33);
  settings.background = true;
  settings.exposure = 0.1f;
  settings.toneMap = ToneMap::aces;
  const std::pair<DebugView, int> expected[] = {
      {DebugView::visibility, 255}, {DebugView::albedo, 188}, {DebugView::roughness, 188}};  // 188: one half, as sRGB
  for (const auto& [view, byte] : expected) {
    settings.debugView = view;
    renderer.render(defaultCamera(baked.scene, 1), settings);
    const Image8 picture = renderer.readDisplay();
    EXPECT_NEAR(picture.texels[4 * (16 * 33 + 16)], byte, 1) << static_cast<int>(view);
    EXPECT_EQ(picture.texels[0], 0) << "the corner, which nothing covers";
  }
}

// Materials at their extremes and a tilted camera: every pixel finite and not negative.
TEST(Renderer, ExtremesStayFinite) {
  const SgEnvironment sunny = prepareEnvironment(loadEnvironment("sunny"));
  for (const float roughness : {0.0f, 0.01f, 0.45f, 0.6f, 1.0f}) {
    for (const float anisotropy : {0.0f, 1.0f}) {
      const BakedScene baked = sphereOf(material(roughness, 1, glm::vec3(1, 0.5f, 0), anisotropy));
      Renderer renderer(baked);
      renderer.setEnvironment(sunny);
      renderer.render(defaultCamera(baked.scene, 1), smallPicture(48));
      for (const auto& texel : renderer.readRadiance().texels)
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(texel[c] >= 0.0f && texel[c] <= 1e6f) << texel[c] << " at roughness " << roughness;
    }
  }
}

// A full turn of the environment is no turn; half a turn about +Y shows what half a turn of the camera shows.
TEST(Renderer, EnvironmentRotatesWithTheCamera) {
  const BakedScene baked = sphereOf(material(0.3f, 1, glm::vec3(0.8f)));
  Renderer renderer(baked);
  renderer.setEnvironment(prepareEnvironment(loadEnvironment("windows")));
  RenderSettings settings = smallPicture(48);
  const Bounds bounds = boundsOf(baked.scene);
  renderer.render(lookAt({0, 0.5f, 3}, {0, 0, 0}, 0.8f, bounds), settings);
  const ImageRgba front = renderer.readRadiance();
  settings.worldFromEnvironment = glm::mat3(glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, -1));
  renderer.render(lookAt({0, 0.5f, -3}, {0, 0, 0}, 0.8f, bounds), settings);
  const ImageRgba turned = renderer.readRadiance();
  double worst = 0;
  for (std::size_t i = 0; i < front.texels.size(); ++i) {
    const double difference = glm::length(glm::vec3(front.texels[i] - turned.texels[i])), size = 0.05 + glm::length(glm::vec3(front.texels[i]));
    // The tessellated silhouette differs by a pixel between the two views.
    if (front.texels[i].a > 0.99f && turned.texels[i].a > 0.99f) worst = std::max(worst, difference / size);
  }
  EXPECT_LE(worst, 0.05);
}

// The same picture of the same scene, whatever its unit; what a vertex holds changes over each triangle here.
TEST(Renderer, DoesNotDependOnTheSizeOfTheScene) {
  Scene scene = builtinScene("sphere");
  scene.cameras.clear();  // the default one follows the scene
  scene.materials = {material(0.8f, 0, glm::vec3(0.8f))};
  for (auto& primitive : scene.primitives) primitive.material = 0;
  const SgEnvironment overcast = prepareEnvironment(loadEnvironment("overcast"));
  const auto draw = [&](float scale) {
    BakedScene baked = unoccluded(scene);
    for (std::size_t p = 0; p < baked.scene.primitives.size(); ++p) {
      auto& visibility = baked.transfer.primitives[p].visibility;
      for (std::size_t i = 0; i < visibility.size(); ++i) visibility[i] = i / 32 % 2 == 0 ? 255 : 64;
      for (auto& position : baked.scene.primitives[p].positions) position *= scale;
    }
    Renderer renderer(baked);
    renderer.setEnvironment(overcast);
    renderer.render(defaultCamera(baked.scene, 1), smallPicture(48));
    return renderer.readRadiance();
  };
  const ImageRgba expected = draw(1.0f);
  EXPECT_GE(covered(expected), 500);
  for (const float scale : {1e-9f, 1e9f}) {
    const ImageRgba image = draw(scale);
    int different = 0;
    for (std::size_t i = 0; i < image.texels.size(); ++i)
      different += !(std::abs(image.texels[i].g - expected.texels[i].g) <= 1e-3f && image.texels[i].a == expected.texels[i].a);
    // Pixels on the outline, where the rounding of a position decides.
    EXPECT_LE(different, 20) << scale;
  }
}

TEST(Renderer, DriverHasNothingToSay) {
  const BakedScene baked = sphereOf(material(0.3f, 0, glm::vec3(0.8f)));
  Renderer renderer(baked);
  renderer.setEnvironment(prepareEnvironment(loadEnvironment("white")));
  RenderSettings settings = smallPicture(16);
  settings.background = true;
  settings.supersample = 2;
  renderer.render(defaultCamera(baked.scene, 1), settings);
  EXPECT_EQ(renderer.readDisplay().texels.size(), 16u * 16u * 4u);
  std::string passes;
  for (const auto& [name, milliseconds] : renderer.timings().passes) passes += name + " ";
  EXPECT_EQ(passes, "depth shade background blended resolve total ");
  EXPECT_NO_THROW(testContext().debugLog().requireClean("a frame"));
}

#ifdef CHIARO_WITH_REFERENCE
// KHR_texture_transform is read alike by both renderers: a self-luminous square, in the dark, with large texels.
TEST(Renderer, TextureTransformsMatchTheReference) {
  Scene scene;
  scene.meshNames = {"square"};
  Primitive square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  square.normals.assign(4, {0, 0, 1});
  square.indices = {0, 1, 2, 0, 2, 3};
  square.material = 0;
  scene.primitives = {square};
  Image8 colors{4, 4, {}};
  for (int i = 0; i < 16; ++i) for (const int byte : {16 * i, 255 - 16 * i, 77 * i % 256, 255}) colors.texels.push_back(static_cast<std::uint8_t>(byte));
  scene.images = {{"colors", "image/png", encodePng(colors)}};
  scene.textures = {{0, Wrap::repeat, Wrap::mirroredRepeat, true}};
  Material m = material(1, 0, glm::vec3(0));
  m.emissiveFactor = glm::vec3(1);
  m.emissiveTexture = 0;
  m.emissiveTransform = {{0.13f, -0.4f}, 0.6f, {1.7f, 1.1f}};
  scene.materials = {m};
  Environment dark = loadEnvironment("white");
  for (auto& texel : dark.radiance.texels) texel = glm::vec3(0);
  const BakedScene baked = unoccluded(scene);
  const Camera camera = lookAt({0, 0, 4}, {0, 0, 0}, 0.5f, boundsOf(scene));
  Renderer renderer(baked);
  renderer.setEnvironment(prepareEnvironment(dark));
  renderer.render(camera, smallPicture(64));
  const ImageRgba picture = renderer.readRadiance();
  ReferenceSettings settings;
  settings.width = settings.height = 64;
  settings.samplesPerPixel = 2;
  settings.background = false;
  const ImageRgba truth = renderReference(scene, dark, camera, settings).radiance;
  int different = 0;
  for (std::size_t i = 0; i < truth.texels.size(); ++i)
    different += !(glm::length(glm::vec3(picture.texels[i] - truth.texels[i])) <= 5e-3f);  // llvmpipe's sRGB is good to 2e-3
  EXPECT_GE(covered(picture), 3000);
  EXPECT_LE(different, 40) << "points on the edge between two texels";
}

// The SG shading alone: at least 32 dB on a metal sphere (a dielectric's reflection counts for less), tone-mapped, object pixels only.
TEST(Renderer, UnoccludedSphereMatchesBruteForce) {
  for (const std::string name : {"sunny", "overcast", "windows"}) {
    const Environment environment = loadEnvironment(name);
    const SgEnvironment prepared = prepareEnvironment(environment);
    const float exposure = autoExposure(environment);
    for (const float roughness : {0.2f, 0.4f, 0.7f}) {
      const BakedScene baked = sphereOf(material(roughness, 1, glm::vec3(0.9f, 0.7f, 0.5f)));
      const Camera camera = defaultCamera(baked.scene, 1);
      Renderer renderer(baked);
      renderer.setEnvironment(prepared);
      renderer.render(camera, smallPicture(64));
      const ImageRgba picture = renderer.readRadiance();
      ReferenceSettings settings;
      settings.width = settings.height = 64;
      settings.samplesPerPixel = 512;
      settings.background = false;
      const ImageRgba truth = renderReference(baked.scene, environment, camera, settings).radiance;
      double squares = 0, count = 0;
      for (std::size_t i = 0; i < truth.texels.size(); ++i) {
        if (!(truth.texels[i].a > 0.99f && picture.texels[i].a > 0.99f)) continue;
        const glm::vec3 d = displayColor(glm::vec3(picture.texels[i]), exposure, ToneMap::neutral) - displayColor(glm::vec3(truth.texels[i]), exposure, ToneMap::neutral);
        squares += glm::dot(d, d);
        count += 3;
      }
      ASSERT_GE(count, 1000);
      const double psnr = 10 * std::log10(count / squares);
      std::printf("%s, roughness %.1f: %.1f dB\n", name.c_str(), static_cast<double>(roughness), psnr);
      EXPECT_GE(psnr, 32.0) << name << " " << roughness;
    }
  }
}
#endif

}  // namespace
}  // namespace chiaro
