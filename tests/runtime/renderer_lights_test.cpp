// Lights with a size, and the diffuse light of environments, beside brute force: a ball over a floor, baked, so that shadows are the transfer's own.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "assets/image/image.h"
#include "assets/scene/light_spec.h"
#include "precompute/reference/reference.h"
#include "runtime/render/renderer.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/runtime/ball_over_floor.h"
#include "tests/runtime/unoccluded.h"

namespace chiaro {
namespace {

constexpr int kSize = 48;

struct Pictures {
  ImageRgba drawn, truth;
  /// Tone-mapped PSNR of what is covered in both, dB.
  double psnr(float exposure) const {
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < truth.texels.size(); ++i) {
      if (!(truth.texels[i].a > 0.99f && drawn.texels[i].a > 0.99f)) continue;
      const glm::vec3 d = displayColor(glm::vec3(drawn.texels[i]), exposure, ToneMap::neutral) - displayColor(glm::vec3(truth.texels[i]), exposure, ToneMap::neutral);
      squares += static_cast<double>(glm::dot(d, d));
      count += 3.0;
    }
    return count > 1000.0 ? 10.0 * std::log10(count / squares) : 0.0;
  }
};

Pictures picturesOf(const BakedScene& baked, const std::string& environment, int samples) {
  const Camera camera = lookAt({2.2f, 2.2f, 3.2f}, {0.0f, 0.3f, 0.0f}, 0.8f, boundsOf(baked.scene));
  const Environment light = loadEnvironment(environment);
  Renderer renderer(baked);
  SgEnvironmentSettings coarse;
  coarse.finestResolution = 64;  // nothing here is a mirror
  renderer.setEnvironment(prepareEnvironment(light, coarse));
  renderer.render(camera, smallPicture(kSize));
  ReferenceSettings settings;
  settings.width = settings.height = kSize;
  settings.samplesPerPixel = samples;
  settings.background = false;
  return {renderer.readRadiance(), renderReference(baked.scene, light, camera, settings).radiance};
}

Material matte() {
  Material m;
  m.baseColorFactor = {0.8f, 0.6f, 0.4f, 1.0f};
  m.metallicFactor = 0.0f;
  m.roughnessFactor = 1.0f;
  m.specularFactor = 0.0f;
  return m;
}

Material glossy() {
  Material m = matte();
  m.specularFactor = 1.0f;
  m.roughnessFactor = 0.35f;
  return m;
}

// Limits some dB under what is measured, of which much is the truth's own noise: a falloff, a solid angle or a shadow that is wrong costs ten and more.
TEST(RendererLights, OfAnySizeMatchBruteForce) {
  BakedScene baked = ballOverFloor(glossy(), 0.15f);
  for (const char* spec : {"sun,direction=-1,-2,-0.5,angle-deg=3,intensity=3", "sphere,at=1,2,0.5,radius=0.3,intensity=8", "disk,at=-1,2,1,target=0,0.4,0,radius=0.5,intensity=8"}) {
    baked.scene.lights = {parseLightSpec(spec)};
    const double got = picturesOf(baked, "black", 128).psnr(1.0f);
    std::printf("%s: %.1f dB\n", spec, got);
    EXPECT_GE(got, 30.0) << spec;
  }
  baked.scene.lights.push_back(parseLightSpec("sphere,at=1,2,0.5,radius=0.3,intensity=4,2,1"));
  const double several = picturesOf(baked, "overcast", 128).psnr(0.5f);
  std::printf("a disk, a sphere and overcast: %.1f dB\n", several);
  EXPECT_GE(several, 30.0);
  EXPECT_NO_THROW(testContext().debugLog().requireClean("lights"));
}

// Lights of the environment by the clamped cosine, the rest by fixed lobes; without occlusion exact but for the environment's own fit.
TEST(RendererLights, DiffuseLightOfEnvironments) {
  const BakedScene baked = ballOverFloor(matte(), 0.15f), open = sphereOf(matte());
  for (const char* environment : {"sunny", "overcast", "windows"}) {
    const float exposure = autoExposure(loadEnvironment(environment));
    const double hidden = picturesOf(baked, environment, 256).psnr(exposure), plain = picturesOf(open, environment, 256).psnr(exposure);
    std::printf("diffuse under %s: %.1f dB, unoccluded %.1f dB\n", environment, hidden, plain);
    EXPECT_GE(hidden, 30.0) << environment;
    EXPECT_GE(plain, 36.0) << environment;
  }
}

// What a vertex sees is stored to infinity: a ball behind a lamp shadows as if it were before it. Nothing is lit from behind, and where nothing is
// behind the lamp all is right. The figure is in docs/accuracy.md.
TEST(RendererLights, WhatIsBehindANearLampShadowsIt) {
  BakedScene baked = ballOverFloor(matte(), 1.0f);
  baked.scene.lights = {parseLightSpec("sphere,at=0,0.6,0,radius=0.05,intensity=1")};
  const Pictures pictures = picturesOf(baked, "black", 64);
  const Camera camera = lookAt({2.2f, 2.2f, 3.2f}, {0.0f, 0.3f, 0.0f}, 0.8f, boundsOf(baked.scene));
  const glm::mat4 worldFromCamera = camera.worldFromCamera;
  double shadowed = 0.0, lost = 0.0, right = 0.0, off = 0.0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float up = std::tan(0.5f * camera.verticalFov);
      const glm::vec3 way = glm::mat3(worldFromCamera) * glm::vec3((2.0f * (static_cast<float>(x) + 0.5f) / kSize - 1.0f) * up, (1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / kSize) * up, -1.0f);
      const glm::vec3 eye(worldFromCamera[3]), on = eye - way * (eye.y / way.y);
      if (!(way.y < 0.0f) || std::abs(on.x) > 1.9f || std::abs(on.z) > 1.9f) continue;
      const std::size_t i = static_cast<std::size_t>(y * kSize + x);
      const float truth = pictures.truth.texels[i].r, drawn = pictures.drawn.texels[i].r;
      // From here the ball, half a metre about (0, 1.5, 0), hides the lamp's direction beyond the lamp.
      const glm::vec3 towards = glm::normalize(glm::vec3(0.0f, 0.6f, 0.0f) - on), middle = glm::vec3(0.0f, 1.5f, 0.0f) - on;
      const float apart = glm::length(middle - towards * glm::dot(middle, towards));
      if (glm::length(glm::cross(glm::normalize(eye - on), glm::vec3(0.0f, 1.5f, 0.0f) - on)) < 0.55f) continue;  // the ball is before the eye
      if (apart < 0.4f) shadowed += static_cast<double>(truth), lost += static_cast<double>(truth - drawn);
      if (apart > 0.6f) right += static_cast<double>(truth), off += static_cast<double>(std::abs(truth - drawn));
    }
  std::printf("behind a lamp: %.2f of the light is lost where a ball is behind it; elsewhere %.3f is off\n", lost / shadowed, off / right);
  EXPECT_LE(off / right, 0.05);
  EXPECT_GE(lost / shadowed, -0.01);
  EXPECT_LE(lost / shadowed, 1.0 + 1e-6);
}

}  // namespace
}  // namespace chiaro
