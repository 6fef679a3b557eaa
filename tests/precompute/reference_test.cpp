#include "precompute/reference/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "assets/builtin/builtin_scene.h"
#include "assets/error.h"
#include "precompute/reference/direct_light.h"
#include "precompute/reference/surface.h"
#include "precompute/reference/texture_sampler.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using namespace reference;

constexpr double kPi = std::numbers::pi;

/// An environment of 256 x 128 texels from a function of the direction.
Environment makeEnvironment(const std::function<glm::dvec3(glm::dvec3)>& radiance) {
  Environment environment{"test", ImageRgb{256, 128, {}}};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) {
      environment.radiance.texels.emplace_back(
          radiance(lobe64::directionFromEquirect(glm::dvec2((x + 0.5) / 256.0, (y + 0.5) / 128.0))));
    }
  }
  return environment;
}

Environment whiteEnvironment() {
  return makeEnvironment([](glm::dvec3) { return glm::dvec3(1.0); });
}

Surface lambert(glm::dvec3 normal, double albedo) {
  Surface surface;
  surface.geometricNormal = surface.interpolatedNormal = normal;
  const glm::dvec3 axis = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(axis, normal));
  surface.worldFromTangent = glm::dmat3(tangent, glm::cross(normal, tangent), normal);
  surface.brdf = {glm::dvec3(albedo), glm::dvec3(0.0), glm::dvec3(0.0), 0.5, 0.5};
  return surface;
}

/// A square of side 2 about the origin, facing `normal` (an axis), with corners in (u, v) order.
Primitive square(glm::vec3 u, glm::vec3 v, glm::vec3 center = glm::vec3(0.0f)) {
  Primitive primitive;
  primitive.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  primitive.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  primitive.normals.assign(4, normal);
  primitive.tangents.assign(4, glm::vec4(glm::normalize(u), 1.0f));
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = 0;
  return primitive;
}

/// One square in the plane z = 0 that faces +Z, and a camera before it.
Scene squareScene() {
  Scene scene;
  scene.meshNames.emplace_back("square");
  scene.materials.resize(1);
  scene.primitives.push_back(square({1, 0, 0}, {0, 1, 0}));
  return scene;
}

Camera cameraAt(glm::vec3 eye) {
  Camera camera = lookAt(eye, glm::vec3(0.0f), 0.2f, {});
  camera.nearPlane = 0.01f;
  camera.farPlane = 100.0f;
  return camera;
}

ReferenceSettings onePixel(int samples = 64) {
  ReferenceSettings settings;
  settings.width = settings.height = 1;
  settings.samplesPerPixel = samples;
  settings.threads = 1;
  return settings;
}

glm::dvec3 pixel(const ReferenceImage& image, int x = 0, int y = 0) { return glm::dvec3(image.radiance.at(x, y)); }

int addTexture(Scene& scene, const Image8& image) {
  scene.images.push_back({"test", "image/png", encodePng(image)});
  scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, Wrap::repeat, Wrap::repeat, false});
  return static_cast<int>(scene.textures.size()) - 1;
}

// ---- the integral over the sphere ----

TEST(ReferenceLight, LambertUnderAWhiteSkyIsItsAlbedo) {
  const Environment environment = whiteEnvironment();
  const EnvironmentSampler sampler(environment, glm::mat3(1.0f));
  const Surface surface = lambert(glm::normalize(glm::dvec3(0.3, 0.5, 0.8)), 0.7);
  // Cosine samples alone have no variance here: exact.
  const Estimate cosine = environmentLight(surface, surface.geometricNormal, sampler, nullptr, 64, 1, Strategy::cosine);
  EXPECT_LE(std::abs(cosine.mean.x - 0.7), 1e-12);
  EXPECT_LE(cosine.varianceOfMean.x, 1e-24);
  const Estimate combined = environmentLight(surface, surface.geometricNormal, sampler, nullptr, 4096, 1);
  EXPECT_LE(std::abs(combined.mean.x - 0.7), 5.0 * std::sqrt(combined.varianceOfMean.x));
  EXPECT_LE(std::sqrt(combined.varianceOfMean.x), 1e-3);
}

TEST(ReferenceLight, LambertUnderACosineSkyAndAHalfSkyIsTheClosedForm) {
  const Environment cosineSky = makeEnvironment([](glm::dvec3 w) { return glm::dvec3(std::max(0.0, w.y)); });
  const Environment halfSky = makeEnvironment([](glm::dvec3 w) { return glm::dvec3(w.y > 0.0 ? 1.0 : 0.0); });
  const EnvironmentSampler cosineSampler(cosineSky, glm::mat3(1.0f));
  const EnvironmentSampler halfSampler(halfSky, glm::mat3(1.0f));
  for (const double theta : {0.0, 0.4, 1.0, kPi / 2, 2.2, 3.0}) {
    const Surface surface = lambert({std::sin(theta), std::cos(theta), 0.0}, 1.0);
    const Estimate cosine = environmentLight(surface, surface.geometricNormal, cosineSampler, nullptr, 1 << 16, 2);
    const double expected = 2.0 / 3.0 * (std::sin(theta) + (kPi - theta) * std::cos(theta)) / kPi;
    // 1e-4: the sky is a picture of 128 rows, bilinear between them, with a kink at the horizon.
    EXPECT_LE(std::abs(cosine.mean.x - expected), 1e-4 + 5.0 * std::sqrt(cosine.varianceOfMean.x)) << theta;
    EXPECT_LE(std::sqrt(cosine.varianceOfMean.x), 2e-4);
    const Estimate half = environmentLight(surface, surface.geometricNormal, halfSampler, nullptr, 1 << 16, 2);
    EXPECT_LE(std::abs(half.mean.x - 0.5 * (1.0 + std::cos(theta))), 1e-4 + 5.0 * std::sqrt(half.varianceOfMean.x)) << theta;
    EXPECT_LE(std::sqrt(half.varianceOfMean.x), 4e-4);
  }
}

TEST(ReferenceLight, AWallBesideAPointHalvesItsLight) {
  Scene scene;
  scene.materials.resize(1);
  scene.primitives.push_back(square({0, 0, 100}, {0, 100, 0}, {0.01f, 0.0f, 0.0f}));
  const RayScene rays(scene);
  const Environment environment = whiteEnvironment();
  const EnvironmentSampler sampler(environment, glm::mat3(1.0f));
  const Surface surface = lambert({0, 1, 0}, 1.0);
  const Estimate estimate = environmentLight(surface, {0, 1, 0}, sampler, &rays, 1 << 16, 3);
  // The wall ends after 100 m, 0.01 m away: it leaves out 1e-4 radians.
  EXPECT_LE(std::abs(estimate.mean.x - 0.5), 1e-4 + 5.0 * std::sqrt(estimate.varianceOfMean.x));
  EXPECT_LE(std::sqrt(estimate.varianceOfMean.x), 1e-3);
  EXPECT_GT(estimate.rays, 1u << 16);
}

TEST(ReferenceLight, TheErrorFallsAsStatedAndAtLeastAsTheRootOfTheSamples) {
  const Environment environment = makeEnvironment([](glm::dvec3 w) { return glm::dvec3(1.0 + std::sin(5.0 * w.x) * w.y); });
  const EnvironmentSampler sampler(environment, glm::mat3(1.0f));
  Surface surface = lambert(glm::normalize(glm::dvec3(0.1, 1.0, 0.2)), 0.5);
  surface.brdf = {glm::dvec3(0.5), glm::dvec3(0.3), glm::dvec3(1.0), 0.3, 0.3};
  const glm::dvec3 wo = glm::normalize(surface.geometricNormal + glm::dvec3(0.5, 0.0, 0.0));
  const double truth = environmentLight(surface, wo, sampler, nullptr, 1 << 21, 99).mean.x;
  const auto errors = [&](int samples) {
    double squared = 0.0;
    double stated = 0.0;
    constexpr int kTrials = 1500;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
      const Estimate estimate = environmentLight(surface, wo, sampler, nullptr, samples, hashWords(trial, 5));
      squared += (estimate.mean.x - truth) * (estimate.mean.x - truth);
      stated += estimate.varianceOfMean.x;
    }
    return std::pair(std::sqrt(squared / kTrials), std::sqrt(stated / kTrials));
  };
  const auto [few, fewStated] = errors(16);
  const auto [many, manyStated] = errors(256);
  // 1500 trials know a standard deviation to 2 %; five times that.
  EXPECT_NEAR(few / fewStated, 1.0, 0.1);
  EXPECT_NEAR(many / manyStated, 1.0, 0.1);
  EXPECT_GE(few / many, 4.0 * 0.9);
}

TEST(ReferenceLight, EveryStrategyGivesTheSameLight) {
  const Environment environment = makeEnvironment([](glm::dvec3 w) {
    return glm::dvec3(0.2 + 20.0 * std::exp(30.0 * (glm::dot(w, glm::normalize(glm::dvec3(0.5, 0.7, 0.2))) - 1.0)));
  });
  Scene scene;
  scene.materials.resize(1);
  scene.primitives.push_back(square({0.3f, 0, 0}, {0, 0, 0.3f}, {0.3f, 0.5f, 0.1f}));
  const RayScene rays(scene);
  // Turned, so that a wrong transform between the world and the map would show.
  const float angle = 0.8f;
  const glm::mat3 turn(std::cos(angle), 0, -std::sin(angle), 0, 1, 0, std::sin(angle), 0, std::cos(angle));
  const EnvironmentSampler sampler(environment, turn);
  Surface surface = lambert({0, 1, 0}, 0.4);
  surface.brdf = {glm::dvec3(0.4), glm::dvec3(0.2), glm::dvec3(1.0), 0.5, 0.25};
  const glm::dvec3 wo = glm::normalize(glm::dvec3(-0.6, 0.7, 0.1));
  const Estimate combined = environmentLight(surface, wo, sampler, &rays, 1 << 17, 1);
  ASSERT_GT(combined.mean.x, 0.1);
  for (const Strategy strategy : {Strategy::light, Strategy::reflection, Strategy::cosine}) {
    const Estimate pure = environmentLight(surface, wo, sampler, &rays, 1 << 17, 2, strategy);
    const double sigma = std::sqrt(pure.varianceOfMean.x + combined.varianceOfMean.x);
    EXPECT_LE(sigma, 0.01 * combined.mean.x);
    EXPECT_LE(std::abs(pure.mean.x - combined.mean.x), 5.0 * sigma) << static_cast<int>(strategy);
  }
}

TEST(ReferenceEnvironment, DensityIntegratesToOneAndSamplesFollowIt) {
  const Environment environment =
      makeEnvironment([](glm::dvec3 w) { return glm::dvec3(w.y > 0.9 ? 50.0 : 0.0, w.x > 0.0 ? 1.0 : 0.0, 0.1 * w.z * w.z); });
  const glm::mat3 turn(0, 0, -1, 0, 1, 0, 1, 0, 0);
  const EnvironmentSampler sampler(environment, turn);
  double total = 0.0;
  glm::dvec3 light(0.0);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 1024; ++x) {
      const glm::dvec3 w = lobe64::directionFromEquirect(glm::dvec2((x + 0.5) / 1024.0, (y + 0.5) / 512.0));
      const double solidAngle = 2.0 * kPi / 1024 * (std::cos(kPi * y / 512) - std::cos(kPi * (y + 1) / 512));
      const EnvironmentSampler::Light at = sampler.at(w);
      total += at.density * solidAngle;
      light += at.radiance * solidAngle;
    }
  }
  EXPECT_NEAR(total, 1.0, 1e-5);
  glm::dvec3 estimate(0.0);
  const PointSet points(1);
  constexpr int kSamples = 1 << 17;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const EnvironmentSampler::Light at = sampler.at(sampler.sample(points.pair(i, 0)));
    ASSERT_GT(at.density, 0.0);
    estimate += at.radiance / (at.density * kSamples);
  }
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(estimate[c] / light[c], 1.0, 2e-3);  // quadrature of 16 points a texel against 131,072 samples
}

TEST(ReferenceEnvironment, ReadsTheMapAsTheSharedConventionSays) {
  // Neighbouring texels of a smooth map differ by 5e-2; a wrong handedness or half a texel would be far off.
  const Environment environment = makeEnvironment([](glm::dvec3 w) { return 2.0 + w; });
  const EnvironmentSampler sampler(environment, glm::mat3(1.0f));
  std::mt19937 random(5);
  std::normal_distribution<double> gaussian;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 w = glm::normalize(glm::dvec3(gaussian(random), gaussian(random), gaussian(random)));
    EXPECT_LE(glm::length(sampler.radiance(w) - (2.0 + w)), 2e-2) << w.x << " " << w.y << " " << w.z;  // poles: clamped rows
  }
}

TEST(ReferenceEnvironment, ABlackOneGivesNothing) {
  const Environment environment = makeEnvironment([](glm::dvec3) { return glm::dvec3(0.0); });
  const EnvironmentSampler sampler(environment, glm::mat3(1.0f));
  EXPECT_FALSE(sampler.anyLight());
  const Estimate estimate = environmentLight(lambert({0, 1, 0}, 1.0), {0, 1, 0}, sampler, nullptr, 16, 1);
  EXPECT_EQ(estimate.mean, glm::dvec3(0.0));
}

// ---- textures and surfaces ----

TEST(ReferenceTexture, WrapsAndInterpolates) {
  Scene scene;
  const int texture = addTexture(scene, Image8{2, 1, {0, 0, 0, 255, 255, 128, 0, 255}});
  const auto at = [&](float u, TextureEncoding encoding = TextureEncoding::linear) {
    return TextureSampler(scene, texture, encoding).at({u, 0.5f});
  };
  EXPECT_NEAR(at(0.25f).x, 0.0f, 1e-6f);
  EXPECT_NEAR(at(0.75f).x, 1.0f, 1e-6f);
  EXPECT_NEAR(at(0.5f).x, 0.5f, 1e-6f);
  EXPECT_NEAR(at(0.0f).x, 0.5f, 1e-6f) << "repeats";
  EXPECT_NEAR(at(-3.25f).x, 1.0f, 1e-6f);
  EXPECT_NEAR(at(1e9f + 64.0f).x, 0.5f, 1e-6f);
  EXPECT_NEAR(at(0.75f).y, 128.0f / 255.0f, 1e-6f);
  EXPECT_NEAR(at(0.75f, TextureEncoding::srgb).y, 0.215861f, 1e-5f) << "IEC 61966-2-1 of 128";
  EXPECT_NEAR(at(0.5f, TextureEncoding::srgb).y, 0.5f * 0.215861f, 1e-5f) << "decoded before it is interpolated";
  EXPECT_EQ(at(std::numeric_limits<float>::quiet_NaN()).x, at(0.0f).x);
  scene.textures[0].wrapS = Wrap::clampToEdge;
  EXPECT_NEAR(at(-5.0f).x, 0.0f, 1e-6f);
  EXPECT_NEAR(at(5.0f).x, 1.0f, 1e-6f);
  scene.textures[0].wrapS = Wrap::mirroredRepeat;
  EXPECT_NEAR(at(1.25f).x, 1.0f, 1e-6f);
  EXPECT_NEAR(at(-0.25f).x, 0.0f, 1e-6f);
  scene.textures[0].nearest = true;
  EXPECT_EQ(at(0.49f).x, 0.0f);
  EXPECT_EQ(at(0.51f).x, 1.0f);
}

// Each slot reads its texture through its own transform.
TEST(ReferenceSurface, TexturesAreReadThroughTheirTransforms) {
  Scene scene = squareScene();
  Material& material = scene.materials[0];
  material.baseColorTexture = material.emissiveTexture = addTexture(scene, Image8{2, 1, {0, 0, 0, 255, 255, 255, 255, 255}});
  scene.textures[0].nearest = true;
  material.emissiveFactor = glm::vec3(1.0f);
  material.emissiveTransform.offset.x = 0.5f;
  const RayScene rays(scene);
  const SurfaceReader reader(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({-0.5f, 0.2f, 1.0f}, {0, 0, -1}, 0.0f, 10.0f, hit));  // U = 1/4: the black texel
  EXPECT_EQ(reader.at(hit, {0, 0, 1}).emission, glm::dvec3(1.0));
  EXPECT_EQ(reader.at(hit, {0, 0, 1}).brdf.f0, glm::dvec3(0.0));
  material.baseColorTransform.rotation = static_cast<float>(kPi / 2);  // V = 2/5 becomes U
  EXPECT_EQ(reader.at(hit, {0, 0, 1}).brdf.f0, glm::dvec3(0.0));
  material.baseColorTransform.scale.y = 2.0f;  // and 4/5
  EXPECT_EQ(reader.at(hit, {0, 0, 1}).brdf.f0, glm::dvec3(1.0));
}

TEST(ReferenceSurface, NormalMapsTurnTowardsTheTangentAndUpTheImage) {
  Scene scene = squareScene();
  // (0.6, 0.48, 0.64): to the right and up.
  scene.materials[0].normalTexture = addTexture(scene, Image8{1, 1, {204, 189, 209, 255}});
  const RayScene rays(scene);
  const SurfaceReader reader(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({0.1f, 0.2f, 1.0f}, {0, 0, -1}, 0.0f, 10.0f, hit));
  const glm::dvec3 front = reader.at(hit, {0, 0, 1}).worldFromTangent[2];
  EXPECT_LE(glm::length(front - glm::dvec3(0.6, 0.48, 0.64)), 5e-3);  // 8 bits
  ASSERT_TRUE(rays.intersect({0.1f, 0.2f, -1.0f}, {0, 0, 1}, 0.0f, 10.0f, hit));
  EXPECT_TRUE(reader.isCulled(hit, {0, 0, 1}));
  scene.materials[0].doubleSided = true;
  EXPECT_FALSE(reader.isCulled(hit, {0, 0, 1}));
  const Surface back = reader.at(hit, {0, 0, -1});
  EXPECT_LE(glm::length(back.worldFromTangent[2] + front), 1e-12) << "the back is the front turned inside out";
  EXPECT_EQ(back.geometricNormal, glm::dvec3(0, 0, -1));
  scene.materials[0].normalScale = 0.0f;
  EXPECT_LE(glm::length(reader.at(hit, {0, 0, -1}).worldFromTangent[2] - glm::dvec3(0, 0, -1)), 1e-12);
}

TEST(ReferenceSurface, AnisotropyWidensAlongItsDirection) {
  Scene scene = squareScene();
  Material& material = scene.materials[0];
  material.roughnessFactor = 0.5f;
  material.anisotropyStrength = 0.7f;
  material.anisotropyRotation = static_cast<float>(kPi / 2);
  const RayScene rays(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({0.1f, 0.2f, 1.0f}, {0, 0, -1}, 0.0f, 10.0f, hit));
  const Surface turned = SurfaceReader(scene).at(hit, {0, 0, 1});
  EXPECT_NEAR(turned.brdf.alphaX, 0.25 + 0.75 * 0.49, 1e-6);
  EXPECT_NEAR(turned.brdf.alphaY, 0.25, 1e-6);
  EXPECT_LE(glm::length(turned.worldFromTangent[0] - glm::dvec3(0, 1, 0)), 1e-6) << "against the clock from the tangent";
  material.anisotropyTexture = addTexture(scene, Image8{1, 1, {0, 128, 128, 255}});  // direction -x, half as strong
  const Surface textured = SurfaceReader(scene).at(hit, {0, 0, 1});
  EXPECT_NEAR(textured.brdf.alphaX, 0.25 + 0.75 * std::pow(0.7 * 128.0 / 255.0, 2.0), 1e-6);
  EXPECT_LE(glm::length(textured.worldFromTangent[0] - glm::dvec3(0, -1, 0)), 5e-3);
}

TEST(ReferenceSurface, MaterialsMixAsGltfSays) {
  Scene scene = squareScene();
  Material& material = scene.materials[0];
  material.baseColorFactor = {0.8f, 0.5f, 0.2f, 0.3f};
  material.metallicFactor = 0.5f;
  material.roughnessFactor = 0.8f;
  material.metallicRoughnessTexture = addTexture(scene, Image8{1, 1, {255, 102, 51, 255}});  // roughness .4, metallic .2
  const RayScene rays(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({0.1f, 0.2f, 1.0f}, {0, 0, -1}, 0.0f, 10.0f, hit));
  const Surface surface = SurfaceReader(scene).at(hit, {0, 0, 1});
  EXPECT_NEAR(surface.brdf.alphaX, 0.32 * 0.32, 1e-6);
  EXPECT_LE(glm::length(surface.brdf.diffuse - 0.9 * glm::dvec3(0.8, 0.5, 0.2)), 1e-6);
  EXPECT_LE(glm::length(surface.brdf.f0 - (0.9 * 0.04 + 0.1 * glm::dvec3(0.8, 0.5, 0.2))), 1e-6);
  EXPECT_EQ(surface.opacity, 1.0) << "alpha counts only where the material blends";
  material.alphaMode = AlphaMode::blend;
  EXPECT_NEAR(SurfaceReader(scene).at(hit, {0, 0, 1}).opacity, 0.3, 1e-6);
}

// ---- pictures ----

/// The whole glTF BRDF under a white sky, from the specification's text and by plain quadrature over directions.
double dielectricUnderWhiteSky(double baseColor, double alpha, double cosine) {
  const glm::dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  double sum = 0.0;
  constexpr int kRows = 200;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < 2 * kRows; ++j) {
      const double z = (i + 0.5) / kRows;
      const double azimuth = kPi * (j + 0.5) / kRows;
      const glm::dvec3 wi(std::sqrt(1.0 - z * z) * std::cos(azimuth), std::sqrt(1.0 - z * z) * std::sin(azimuth), z);
      const glm::dvec3 wh = glm::normalize(wo + wi);
      const double fresnel = 0.04 + 0.96 * std::pow(1.0 - glm::dot(wo, wh), 5.0);
      const double specular = lobe64::ggxDistribution(wh.z, alpha) * lobe64::ggxVisibility(wo.z, wi.z, alpha);
      sum += (fresnel * specular + (1.0 - fresnel) * baseColor / kPi) * z;
    }
  }
  return sum * 2.0 * kPi / (2.0 * kRows * kRows);
}

TEST(ReferencePicture, ASphereUnderAWhiteSkyIsTheQuadrature) {
  Scene scene = builtinScene("sphere");
  scene.materials[0].baseColorFactor = {0.6f, 0.6f, 0.6f, 1.0f};
  scene.materials[0].roughnessFactor = 0.7f;
  const Camera camera = scene.cameras[0];
  ReferenceSettings settings;
  settings.width = settings.height = 24;
  settings.samplesPerPixel = 256;
  settings.background = false;
  const ReferenceImage image = renderReference(scene, whiteEnvironment(), camera, settings);
  const glm::dmat4 world(camera.worldFromCamera);
  double errorSum = 0.0;
  double varianceSum = 0.0;
  int count = 0;
  for (int y = 0; y < settings.height; ++y) {
    for (int x = 0; x < settings.width; ++x) {
      // The same ray against the ideal sphere.
      const double scale = std::tan(0.5 * static_cast<double>(camera.verticalFov));
      const glm::dvec3 local(scale * (2.0 * (x + 0.5) / settings.width - 1.0), scale * (1.0 - 2.0 * (y + 0.5) / settings.height),
                             -1.0);
      const glm::dvec3 d = glm::normalize(glm::dmat3(world) * local);
      const glm::dvec3 o(world[3]);
      const double b = glm::dot(o, d);
      const double discriminant = b * b - glm::dot(o, o) + 1.0;
      const double alpha = static_cast<double>(image.radiance.at(x, y).a);
      if (discriminant < -0.01) {
        EXPECT_EQ(alpha, 0.0);
      }
      if (!(discriminant > 0.05)) continue;  // the rim: facets differ from the sphere there
      ASSERT_EQ(alpha, 1.0);
      const double cosine = std::sqrt(discriminant);
      const double expected = dielectricUnderWhiteSky(static_cast<double>(0.6f), 0.49, cosine);
      const double sigma = std::sqrt(static_cast<double>(image.varianceOfMean.at(x, y).x));
      const double error = pixel(image, x, y).x - expected;
      // 8 sets know their own deviation roughly: six of them, over a floor for facets that turn cosines by 1e-3.
      EXPECT_LE(std::abs(error), 6.0 * sigma + 2e-3) << x << "," << y;
      errorSum += error;
      varianceSum += sigma * sigma;
      ++count;
    }
  }
  ASSERT_GT(count, 200);
  EXPECT_LE(std::abs(errorSum / count), 4.0 * std::sqrt(varianceSum) / count + 2e-4) << "no bias on average";
}

TEST(ReferencePicture, AMirrorShowsTheEnvironment) {
  Scene scene = squareScene();
  scene.materials[0].roughnessFactor = 0.0f;
  scene.materials[0].metallicFactor = 1.0f;
  const Environment environment = makeEnvironment([](glm::dvec3 w) { return 2.0 + w; });
  const glm::vec3 eye(1.5f, 0.5f, 2.0f);
  const glm::dvec3 towards = glm::normalize(glm::dvec3(eye));
  const glm::dvec3 reflected(-towards.x, -towards.y, towards.z);
  const ReferenceImage image = renderReference(scene, environment, cameraAt(eye), onePixel());
  const glm::dvec3 expected = EnvironmentSampler(environment, glm::mat3(1.0f)).radiance(reflected);
  EXPECT_LE(glm::length(pixel(image) - expected), 1e-3);  // the lobe is 1e-4 wide; G loses less than that
}

TEST(ReferencePicture, DoesNotDependOnTheNumberOfThreads) {
  const Scene scene = builtinScene("sphere");
  const Environment environment = whiteEnvironment();
  ReferenceSettings settings;
  settings.width = 50;
  settings.height = 37;
  settings.samplesPerPixel = 8;
  settings.pixelGrid = 2;
  settings.threads = 1;
  const ReferenceImage one = renderReference(scene, environment, scene.cameras[0], settings);
  for (const int threads : {2, 7}) {
    settings.threads = threads;
    double last = 0.0;
    const ReferenceImage many =
        renderReference(scene, environment, scene.cameras[0], settings, [&](const std::string&, double done) {
          EXPECT_GT(done, last);
          last = done;
        });
    EXPECT_EQ(last, 1.0);
    EXPECT_EQ(one.radiance.texels, many.radiance.texels);
    EXPECT_EQ(one.varianceOfMean.texels, many.varianceOfMean.texels);
    EXPECT_EQ(one.noiseRms, many.noiseRms);
    EXPECT_EQ(one.raysTraced, many.raysTraced);
  }
  settings.seed = 1;
  EXPECT_NE(one.radiance.texels, renderReference(scene, environment, scene.cameras[0], settings).radiance.texels);
}

TEST(ReferencePicture, DoesNotDependOnTheSizeOfTheScene) {
  const Scene original = builtinScene("ornament");
  const Environment environment = makeEnvironment([](glm::dvec3 w) { return glm::dvec3(1.0 + w.y, 1.0, 1.0 + 0.5 * w.x); });
  ReferenceSettings settings;
  settings.width = 64;
  settings.height = 48;
  settings.samplesPerPixel = 16;
  const ReferenceImage expected = renderReference(original, environment, original.cameras[0], settings);
  double mean = 0.0;
  for (const glm::vec4& texel : expected.radiance.texels)
    mean += static_cast<double>(texel.y) / static_cast<double>(expected.radiance.texels.size());
  for (const float scale : {1e-3f, 1e4f}) {
    Scene scene = original;
    for (Primitive& primitive : scene.primitives) {
      for (glm::vec3& position : primitive.positions) position *= scale;
    }
    Camera camera = original.cameras[0];
    camera.worldFromCamera[3] = glm::vec4(scale * glm::vec3(camera.worldFromCamera[3]), 1.0f);
    camera.nearPlane *= scale;
    camera.farPlane *= scale;
    const ReferenceImage image = renderReference(scene, environment, camera, settings);
    // The same random numbers: only rays that pass an edge by a rounding error may differ.
    double squared = 0.0;
    int different = 0;
    for (std::size_t i = 0; i < image.radiance.texels.size(); ++i) {
      const double difference =
          static_cast<double>(image.radiance.texels[i].y) - static_cast<double>(expected.radiance.texels[i].y);
      squared += difference * difference;
      if (!(std::abs(difference) <= 1e-3 * mean)) ++different;
    }
    EXPECT_LE(std::sqrt(squared / static_cast<double>(image.radiance.texels.size())), 0.1 * expected.noiseRms) << scale;
    EXPECT_LE(different, static_cast<int>(image.radiance.texels.size() / 100)) << scale;
  }
}

TEST(ReferencePicture, LampsFollowTheirFormulas) {
  Scene scene = squareScene();
  Material& material = scene.materials[0];
  material.baseColorFactor = {0.5f, 0.5f, 0.5f, 1.0f};
  material.metallicFactor = 0.0f;
  material.roughnessFactor = 0.8f;
  const Environment black = makeEnvironment([](glm::dvec3) { return glm::dvec3(0.0); });
  const Camera camera = cameraAt({0, 0, 3});
  // All along the normal: D = 1 / (pi alpha^2), V = 1/4, F = 0.04.
  const double f = 0.04 / (4.0 * kPi * std::pow(0.8, 4.0)) + 0.96 * 0.5 / kPi;
  Light light;
  light.intensity = 7.0f;
  light.color = {1.0f, 0.5f, 0.25f};
  scene.lights = {light};
  const auto shown = [&] { return pixel(renderReference(scene, black, camera, onePixel())); };
  EXPECT_LE(glm::length(shown() - 7.0 * f * glm::dvec3(1.0, 0.5, 0.25)), 1e-5);
  scene.lights[0].type = LightType::point;
  scene.lights[0].position = {0, 0, 2};
  EXPECT_NEAR(shown().x, 7.0 * f / 4.0, 1e-5);
  scene.lights[0].range = 2.5f;
  EXPECT_NEAR(shown().x, 7.0 * f / 4.0 * (1.0 - std::pow(0.8, 4.0)), 1e-5);
  scene.lights[0].range = 1.9f;
  EXPECT_EQ(shown().x, 0.0);
  scene.lights[0].range = std::numeric_limits<float>::infinity();
  scene.lights[0].type = LightType::spot;
  scene.lights[0].innerConeAngle = 0.2f;
  scene.lights[0].outerConeAngle = 0.6f;
  scene.lights[0].direction = {std::sin(0.4f), 0.0f, -std::cos(0.4f)};
  const double edge = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
  EXPECT_NEAR(shown().x, 7.0 * f / 4.0 * edge * edge, 1e-5);
  // A square between the lamp and the surface, out of the camera's way.
  scene.lights[0].type = LightType::directional;
  scene.lights[0].direction = glm::normalize(glm::vec3(-1.0f, 0.0f, -1.0f));
  EXPECT_GT(shown().x, 0.1);
  scene.primitives.push_back(square({0.2f, 0, 0}, {0, 0.2f, 0}, {1.0f, 0.0f, 1.0f}));
  EXPECT_EQ(shown().x, 0.0);
  ReferenceSettings unshadowed = onePixel();
  unshadowed.shadows = false;
  EXPECT_GT(pixel(renderReference(scene, black, camera, unshadowed)).x, 0.1);
}

TEST(ReferencePicture, BlendedSurfacesLieOverWhatIsBehind) {
  Scene scene = squareScene();
  scene.materials[0].emissiveFactor = {0.0f, 3.0f, 0.0f};
  scene.materials[0].doubleSided = true;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].emissiveFactor = {2.0f, 0.0f, 0.0f};
  scene.materials[1].alphaMode = AlphaMode::blend;
  scene.materials[1].baseColorFactor.a = 0.25f;
  scene.primitives.push_back(square({1, 0, 0}, {0, 1, 0}, {0, 0, 0.5f}));
  scene.primitives[1].material = 1;
  const Environment black = makeEnvironment([](glm::dvec3) { return glm::dvec3(0.0); });
  const ReferenceImage over = renderReference(scene, black, cameraAt({0, 0, 3}), onePixel());
  EXPECT_LE(glm::length(pixel(over) - glm::dvec3(0.5, 2.25, 0.0)), 1e-6);
  EXPECT_EQ(over.radiance.at(0, 0).a, 1.0f);
  // From behind the opaque one hides it.
  EXPECT_LE(glm::length(pixel(renderReference(scene, black, cameraAt({0, 0, -3}), onePixel())) - glm::dvec3(0.0, 3.0, 0.0)),
            1e-6);
  // Alone it lets the background through.
  scene.primitives.erase(scene.primitives.begin());
  scene.materials[1].metallicFactor = 1.0f;
  scene.materials[1].baseColorFactor = {0.0f, 0.0f, 0.0f, 0.25f};
  const Environment white = whiteEnvironment();
  const ReferenceImage through = renderReference(scene, white, cameraAt({0, 0, 3}), onePixel(1024));
  EXPECT_NEAR(through.radiance.at(0, 0).a, 0.25f, 1e-6f);
  // Black metal still reflects a little at grazing angles of wh.
  EXPECT_NEAR(pixel(through).y, 0.75, 0.01);
}

TEST(ReferencePicture, OneSidedSurfacesShowNoBack) {
  Scene scene = squareScene();
  scene.materials[0].emissiveFactor = {0.0f, 3.0f, 0.0f};
  const Environment white = whiteEnvironment();
  ReferenceSettings settings = onePixel();
  const ReferenceImage culled = renderReference(scene, white, cameraAt({0, 0, -3}), settings);
  EXPECT_EQ(culled.radiance.at(0, 0).a, 0.0f);
  EXPECT_LE(glm::length(pixel(culled) - glm::dvec3(1.0)), 1e-6);
  settings.background = false;
  EXPECT_EQ(pixel(renderReference(scene, white, cameraAt({0, 0, -3}), settings)), glm::dvec3(0.0));
  scene.materials[0].doubleSided = true;
  EXPECT_EQ(renderReference(scene, white, cameraAt({0, 0, -3}), settings).radiance.at(0, 0).a, 1.0f);
}

TEST(ReferencePicture, AnOrthographicCameraSeesItsExtent) {
  Scene scene = squareScene();
  Camera camera = cameraAt({0, 0, 3});
  camera.perspective = false;
  camera.verticalExtent = 2.0f;
  ReferenceSettings settings;
  settings.width = 16;
  settings.height = 8;
  settings.samplesPerPixel = 2;
  settings.background = false;
  const ReferenceImage image = renderReference(scene, whiteEnvironment(), camera, settings);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x)
      EXPECT_EQ(image.radiance.at(x, y).a, x >= 6 && x < 10 && y >= 2 && y < 6 ? 1.0f : 0.0f) << x << "," << y;
  }
}

TEST(ReferencePicture, RefusesSettingsItCannotRender) {
  const Scene scene = squareScene();
  ReferenceSettings settings = onePixel(1);
  EXPECT_THROW(renderReference(scene, whiteEnvironment(), cameraAt({0, 0, 3}), settings), Error);
  settings = onePixel();
  settings.width = 0;
  EXPECT_THROW(renderReference(scene, whiteEnvironment(), cameraAt({0, 0, 3}), settings), Error);
  EXPECT_THROW(renderReference(scene, Environment{}, cameraAt({0, 0, 3}), onePixel()), Error);
}

}  // namespace
}  // namespace chiaro
