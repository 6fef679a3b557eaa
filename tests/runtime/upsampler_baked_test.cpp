// Upsampled frames of a baked scene, where things hide one another.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "assets/image/display.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/runtime/ball_over_floor.h"
#include "tests/runtime/upsampled.h"

namespace chiaro {
namespace {

constexpr int kWide = 64;

/// Baked once; what a bake stores knows nothing of the material.
const BakedScene& ball() {
  static const BakedScene baked = ballOverFloor(matte(), 0.15f);
  return baked;
}

Camera onto(const BakedScene& baked, float degrees) {
  const float a = degrees * 0.01745329252f;
  return lookAt({3.5f * std::sin(a), 2.2f, 3.5f * std::cos(a)}, {0.0f, 0.3f, 0.0f}, 0.8f, boundsOf(baked.scene));
}

RenderSettings wide(int cell, float recompute = 0.0f) {
  RenderSettings settings = upsampled(cell, UpsampleWeights::lobe, recompute);
  settings.width = settings.height = kWide;
  return settings;
}

ImageRgba encoded(ImageRgba image, float exposure) {
  for (auto& texel : image.texels) texel = glm::vec4(displayColor(glm::vec3(texel), exposure, ToneMap::neutral), texel.a);
  return image;
}

/// What polished metal is off by while the camera turns, tone-mapped, four frames together.
double errorOf(Renderer& full, Renderer& test, const std::string& light, bool estimate) {
  full.setEnvironment(environment(light));
  test.setEnvironment(environment(light));
  const float exposure = autoExposure(loadEnvironment(light));
  RenderSettings settings = wide(4);
  settings.upsampleEstimate = estimate;
  double error = 0.0;
  for (int f = 0; f < 8; ++f) {
    const Camera camera = onto(ball(), 0.5f * static_cast<float>(f));
    const ImageRgba image = frame(test, camera, settings);
    if (f >= 4) error += rmse(encoded(image, exposure), encoded(frame(full, camera, wide(1)), exposure));
  }
  return error;
}

// Edges of what is mirrored, and of a sun's shadow on what is rough, are where full shading has them: without the estimate they are where four pixels
// put them. Measured: .15 to .48 of the error without.
TEST(UpsamplerBaked, TheEstimateKnowsWhatHides) {
  Renderer full(ball()), test(ball());
  for (const float roughness : {0.15f, 0.8f}) {
    full.setMaterials({metal(roughness)});
    test.setMaterials({metal(roughness)});
    for (const char* light : {"sunny", "windows"}) {
      const double plain = errorOf(full, test, light, false), estimated = errorOf(full, test, light, true);
      std::printf("roughness %.2f under %s: %.4f of %.4f\n", static_cast<double>(roughness), light, estimated, plain);
      EXPECT_LE(estimated, 0.6 * plain) << light << ", roughness " << roughness;
    }
  }
}

TEST(UpsamplerBaked, StaysFiniteAtTheExtremes) {
  Material exponent = metal(0.5f);
  exponent.reflectance = Reflectance::blinnPhong;
  exponent.reflectanceWidth = glm::vec2(1e6f);
  Material flat = metal(1.0f);  // exponent 0 before models bound it
  flat.reflectance = Reflectance::blinnPhong;
  Material coated = metal(1.0f);
  coated.clearcoatFactor = 1.0f;
  coated.clearcoatRoughness = 0.0f;
  Renderer renderer(ball());
  for (const Material& material : {metal(0.0f), metal(1.0f), matte(), exponent, flat, coated}) {
    renderer.setMaterials({material});
    for (const char* light : {"sunny", "black"}) {
      renderer.setEnvironment(environment(light));
      for (const bool shadows : {true, false})
        for (int f = 0; f < 2; ++f) {
          RenderSettings settings = wide(4, 0.05f);
          settings.shadows = shadows;
          const float most = largest(frame(renderer, onto(ball(), 2.0f * static_cast<float>(f)), settings));
          EXPECT_TRUE(std::string(light) == "black" ? most == 0.0f : most > 0.0f && most < 1e6f) << most << " under " << light;
        }
    }
  }
}

// Textures of one renderer may lie where those of the last did: nothing that is there may show.
TEST(UpsamplerBaked, AnotherSceneKeepsNothing) {
  const BakedScene bright = sphereOf(matte());
  for (int time = 0; time < 2; ++time) {
    auto renderer = std::make_unique<Renderer>(bright);
    renderer->setEnvironment(environment("white"));
    ImageRgba image;
    for (int f = 0; f < 6; ++f) image = frame(*renderer, onto(bright, 0.0f), wide(4));
    ASSERT_GT(largest(image), 0.5f);
    renderer.reset();
    renderer = std::make_unique<Renderer>(ball());
    renderer->setEnvironment(environment("black"));
    EXPECT_EQ(largest(frame(*renderer, onto(ball(), 0.0f), wide(4))), 0.0f);
  }
}

}  // namespace
}  // namespace chiaro
