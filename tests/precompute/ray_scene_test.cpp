#include "precompute/embree/ray_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "assets/image/image.h"

namespace chiaro {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A unit quad in the plane y = height, facing up, times `scale`.
Primitive quad(float height, float scale = 1.0f) {
  Primitive primitive;
  primitive.positions = {scale * glm::vec3(-1, height, -1), scale * glm::vec3(-1, height, 1), scale * glm::vec3(1, height, 1),
                         scale * glm::vec3(1, height, -1)};
  primitive.texcoords = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  return primitive;
}

/// Two texels: left opaque, right alpha `rightAlpha`.
int addHalfTransparentTexture(Scene& scene, std::uint8_t rightAlpha) {
  Image8 image{2, 1, {255, 255, 255, 255, 255, 255, 255, rightAlpha}};
  scene.images.push_back({"half", "image/png", encodePng(image)});
  scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, Wrap::clampToEdge, Wrap::clampToEdge, true});
  return static_cast<int>(scene.textures.size()) - 1;
}

TEST(RayScene, ReportsTheNearestHit) {
  Scene scene;
  scene.primitives = {quad(0.0f), quad(1.0f)};
  const RayScene rays(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({0.5f, 3.0f, 0.25f}, {0, -1, 0}, 0.0f, kFar, hit));
  EXPECT_EQ(hit.primitive, 1u);
  EXPECT_FLOAT_EQ(hit.distance, 2.0f);
  EXPECT_EQ(hit.geometricNormal, glm::vec3(0, 1, 0));
  const Primitive& primitive = scene.primitives[1];
  const std::uint32_t* corner = &primitive.indices[3 * hit.triangle];
  const glm::vec3 position = (1.0f - hit.barycentric.x - hit.barycentric.y) * primitive.positions[corner[0]] +
                             hit.barycentric.x * primitive.positions[corner[1]] +
                             hit.barycentric.y * primitive.positions[corner[2]];
  EXPECT_LE(glm::length(position - glm::vec3(0.5f, 1.0f, 0.25f)), 1e-6f);
  ASSERT_TRUE(rays.intersect({0.5f, 3.0f, 0.25f}, {0, -1, 0}, 2.5f, kFar, hit)) << "tnear skips the upper quad";
  EXPECT_EQ(hit.primitive, 0u);
  EXPECT_FALSE(rays.intersect({0.5f, 3.0f, 0.25f}, {0, -1, 0}, 0.0f, 1.9f, hit)) << "tfar stops short";
  EXPECT_FALSE(rays.occluded({0.5f, 3.0f, 0.25f}, {0, -1, 0}, 0.0f, 1.9f));
  EXPECT_TRUE(rays.occluded({0.5f, 3.0f, 0.25f}, {0, -1, 0}, 0.0f, 2.1f));
  EXPECT_TRUE(rays.occluded({0.5f, -3.0f, 0.25f}, {0, 1, 0}, 0.0f, kFar)) << "both sides occlude";
}

TEST(RayScene, AnEmptySceneHidesNothing) {
  const Scene scene;
  const RayScene rays(scene);
  RayHit hit;
  EXPECT_FALSE(rays.intersect({0, 0, 0}, {0, 1, 0}, 0.0f, kFar, hit));
  EXPECT_FALSE(rays.occluded({0, 0, 0}, {0, 1, 0}, 0.0f, kFar));
}

TEST(RayScene, RaysThatAreNotFiniteHitNothing) {
  Scene scene;
  scene.primitives = {quad(0.0f)};
  const RayScene rays(scene);
  RayHit hit;
  for (const float bad : {kNan, kFar, -kFar}) {
    EXPECT_FALSE(rays.intersect({bad, 1, 0}, {0, -1, 0}, 0.0f, kFar, hit));
    EXPECT_FALSE(rays.intersect({0, 1, 0}, {0, bad, 0}, 0.0f, kFar, hit));
    EXPECT_FALSE(rays.occluded({0, bad, 0}, {0, -1, 0}, 0.0f, kFar));
    EXPECT_FALSE(rays.occluded({0, 1, 0}, {bad, -1, 0}, 0.0f, kFar));
    alignas(64) std::array<float, 16> x{};
    alignas(64) std::array<float, 16> y{};
    alignas(64) std::array<float, 16> z{};
    y.fill(-1.0f);
    x[3] = bad;
    EXPECT_EQ(rays.occluded16({0, 1, 0}, x.data(), y.data(), z.data(), 0xffffu, 0.0f, kFar), 0xffffu & ~(1u << 3));
    EXPECT_EQ(rays.occluded16({0, bad, 0}, x.data(), y.data(), z.data(), 0xffffu, 0.0f, kFar), 0u);
  }
}

TEST(RayScene, TrianglesThatAreNotFiniteAreIgnored) {
  Scene scene;
  scene.primitives = {quad(0.0f), quad(1.0f)};
  for (auto& position : scene.primitives[1].positions) position.y = kNan;
  const RayScene rays(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({0.5f, 3.0f, 0.25f}, {0, -1, 0}, 0.0f, kFar, hit));
  EXPECT_EQ(hit.primitive, 0u);
}

TEST(RayScene, SixteenRaysAgreeWithOne) {
  Scene scene;
  scene.primitives = {quad(0.0f), quad(0.7f)};
  scene.materials.resize(1);
  scene.primitives[1].material = 0;
  scene.materials[0].alphaMode = AlphaMode::mask;
  scene.materials[0].baseColorTexture = addHalfTransparentTexture(scene, 0);
  const RayScene rays(scene);
  std::mt19937 random(1);
  std::normal_distribution<float> gaussian;
  int occludedCount = 0;
  for (int packet = 0; packet < 500; ++packet) {
    const glm::vec3 origin = 0.7f * glm::vec3(gaussian(random), gaussian(random), gaussian(random));
    alignas(64) std::array<float, 16> x{};
    alignas(64) std::array<float, 16> y{};
    alignas(64) std::array<float, 16> z{};
    std::uint32_t expected = 0;
    const std::uint32_t active = static_cast<std::uint32_t>(random()) & 0xffffu;
    for (std::size_t i = 0; i < 16; ++i) {
      const glm::vec3 direction = glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random)));
      x[i] = direction.x;
      y[i] = direction.y;
      z[i] = direction.z;
      if (rays.occluded(origin, direction, 0.0f, kFar)) expected |= 1u << i;
    }
    EXPECT_EQ(rays.occluded16(origin, x.data(), y.data(), z.data(), active, 0.0f, kFar), expected & active);
    occludedCount += std::popcount(expected);
  }
  EXPECT_GT(occludedCount, 500);  // the comparison saw both answers
  EXPECT_LT(occludedCount, 7500);
}

TEST(RayScene, MaskedTrianglesAreHitOnlyWhereTheirAlphaReachesTheCutoff) {
  Scene scene;
  scene.primitives = {quad(0.0f)};
  scene.primitives[0].material = 0;
  scene.materials.resize(1);
  scene.materials[0].alphaMode = AlphaMode::mask;
  scene.materials[0].baseColorTexture = addHalfTransparentTexture(scene, 100);
  const auto hitsRightHalf = [&](float cutoff, float factor) {
    scene.materials[0].alphaCutoff = cutoff;
    scene.materials[0].baseColorFactor.a = factor;
    const RayScene rays(scene);
    RayHit hit;
    const bool left = rays.occluded({-0.5f, 1, 0.1f}, {0, -1, 0}, 0.0f, kFar);
    EXPECT_TRUE(left);
    const bool right = rays.occluded({0.5f, 1, 0.1f}, {0, -1, 0}, 0.0f, kFar);
    EXPECT_EQ(right, rays.intersect({0.5f, 1, 0.1f}, {0, -1, 0}, 0.0f, kFar, hit));
    return right;
  };
  EXPECT_FALSE(hitsRightHalf(0.5f, 1.0f));
  EXPECT_TRUE(hitsRightHalf(0.39f, 1.0f));   // 100/255 = 0.392
  EXPECT_FALSE(hitsRightHalf(0.39f, 0.9f));  // the factor multiplies the texture
}

TEST(RayScene, AMaskWithoutTextureIsAllOrNothing) {
  Scene scene;
  scene.primitives = {quad(0.0f)};
  scene.primitives[0].material = 0;
  scene.materials.resize(1);
  scene.materials[0].alphaMode = AlphaMode::mask;
  scene.materials[0].baseColorFactor.a = 0.4f;
  EXPECT_FALSE(RayScene(scene).occluded({0.5f, 1, 0.1f}, {0, -1, 0}, 0.0f, kFar));
  scene.materials[0].alphaCutoff = 0.4f;
  EXPECT_TRUE(RayScene(scene).occluded({0.5f, 1, 0.1f}, {0, -1, 0}, 0.0f, kFar));
}

TEST(RayScene, BlendedTrianglesAreMetButOccludeNothing) {
  Scene scene;
  scene.primitives = {quad(0.0f), quad(1.0f)};
  scene.primitives[1].material = 0;
  scene.materials.resize(1);
  scene.materials[0].alphaMode = AlphaMode::blend;
  const RayScene rays(scene);
  RayHit hit;
  ASSERT_TRUE(rays.intersect({0.5f, 3, 0.1f}, {0, -1, 0}, 0.0f, kFar, hit));
  EXPECT_EQ(hit.primitive, 1u);
  EXPECT_FALSE(rays.occluded({0.5f, 3, 0.1f}, {0, -1, 0}, 0.0f, 2.5f));
  EXPECT_TRUE(rays.occluded({0.5f, 3, 0.1f}, {0, -1, 0}, 0.0f, kFar)) << "the opaque quad under it still does";
}

/// Points on the faces of a tessellated sphere, at scales and distances from the world's origin that leave few mantissa bits:
/// no ray that leaves the convex hull may hit it again, and every ray inwards must.
TEST(RayScene, OffsetRaysNeitherHitTheirOwnSurfaceNorMissIt) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    for (const float shift : {0.0f, 100.0f}) {
      Scene scene;
      Primitive sphere;
      constexpr int kRings = 48;
      constexpr int kColumns = 96;
      for (int ring = 0; ring <= kRings; ++ring) {
        for (int column = 0; column <= kColumns; ++column) {
          const double theta = M_PI * ring / kRings;
          const double phi = 2.0 * M_PI * column / kColumns;
          sphere.positions.push_back(
              scale *
              (glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)) + glm::vec3(shift)));
        }
      }
      for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        for (std::uint32_t column = 0; column < kColumns; ++column) {
          const std::uint32_t a = ring * (kColumns + 1) + column;
          const std::uint32_t b = a + kColumns + 1;
          sphere.indices.insert(sphere.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
        }
      }
      scene.primitives.push_back(sphere);
      const RayScene rays(scene);
      std::mt19937 random(7);
      std::uniform_real_distribution<float> uniform(0.05f, 0.45f);
      std::normal_distribution<float> gaussian;
      int wrong = 0;
      for (int sample = 0; sample < 20000; ++sample) {
        const std::size_t triangle = random() % sphere.triangleCount();
        const glm::vec3 a = sphere.positions[sphere.indices[3 * triangle]];
        const glm::vec3 b = sphere.positions[sphere.indices[3 * triangle + 1]];
        const glm::vec3 c = sphere.positions[sphere.indices[3 * triangle + 2]];
        const glm::vec3 cross = glm::cross((b - a) / scale, (c - a) / scale);
        if (glm::length(cross) < 1e-6f) continue;  // at the poles
        const glm::vec3 normal = glm::normalize(cross);
        const float u = uniform(random);
        const float v = uniform(random);
        const glm::vec3 position = (1.0f - u - v) * a + u * b + v * c;
        glm::vec3 direction = glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random)));
        if (glm::dot(direction, normal) < 0.0f) direction = -direction;
        const glm::vec3 origin = position + rays.surfaceOffset(position) * normal;
        if (rays.occluded(origin, direction, 0.0f, kFar)) ++wrong;
        // 0.2 keeps the ray inside for longer than the offset: below that it may leave through the next facet.
        if (glm::dot(direction, normal) > 0.2f && !rays.occluded(origin, -direction, 0.0f, kFar)) ++wrong;
      }
      EXPECT_EQ(wrong, 0) << "scale " << scale << " shift " << shift;
    }
  }
}

}  // namespace
}  // namespace chiaro
