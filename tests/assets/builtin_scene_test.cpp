#include "assets/builtin/builtin_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "assets/error.h"
#include "assets/image/image.h"

namespace chiaro {
namespace {

class BuiltinScene : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(All, BuiltinScene, testing::ValuesIn(builtinSceneNames()),
                         [](const auto& parameter) { return parameter.param; });

TEST_P(BuiltinScene, HasWholeAttributesAndIndicesInRange) {
  const Scene scene = builtinScene(GetParam());
  ASSERT_FALSE(scene.primitives.empty());
  ASSERT_EQ(scene.cameras.size(), 1u);
  for (const Primitive& primitive : scene.primitives) {
    const std::size_t count = primitive.positions.size();
    ASSERT_EQ(primitive.normals.size(), count);
    ASSERT_EQ(primitive.tangents.size(), count);
    ASSERT_EQ(primitive.texcoords.size(), count);
    for (const auto index : primitive.indices) ASSERT_LT(index, count);
    double worst = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 normal(primitive.normals[i]);
      const glm::dvec3 tangent(primitive.tangents[i]);
      const double error =
          std::max({std::abs(glm::length(normal) - 1.0), std::abs(glm::length(tangent) - 1.0),
                    std::abs(glm::dot(normal, tangent)), std::abs(std::abs(static_cast<double>(primitive.tangents[i].w)) - 1.0)});
      if (!(error <= worst)) worst = error;
    }
    EXPECT_LE(worst, 1e-6) << primitive.name;  // float rounding of unit vectors
  }
}

TEST_P(BuiltinScene, TrianglesFaceAsTheirNormalsDo) {
  const Scene scene = builtinScene(GetParam());
  for (const Primitive& primitive : scene.primitives) {
    std::size_t against = 0;
    for (std::size_t triangle = 0; triangle < primitive.triangleCount(); ++triangle) {
      const std::uint32_t* corner = &primitive.indices[3 * triangle];
      const glm::dvec3 a(primitive.positions[corner[0]]);
      const glm::dvec3 cross =
          glm::cross(glm::dvec3(primitive.positions[corner[1]]) - a, glm::dvec3(primitive.positions[corner[2]]) - a);
      const glm::dvec3 normal(primitive.normals[corner[0]] + primitive.normals[corner[1]] + primitive.normals[corner[2]]);
      if (!(glm::dot(cross, normal) > 0.0)) ++against;
    }
    EXPECT_EQ(against, 0u) << primitive.name;
  }
}

/// Tangents and texture coordinates must agree, or normal maps would bulge the wrong way: along the tangent u grows, along the bitangent
/// (up the image) v falls.
TEST_P(BuiltinScene, TangentsFollowTheTextureCoordinates) {
  const Scene scene = builtinScene(GetParam());
  for (const Primitive& primitive : scene.primitives) {
    std::size_t wrong = 0;
    for (std::size_t triangle = 0; triangle < primitive.triangleCount(); ++triangle) {
      const std::uint32_t* corner = &primitive.indices[3 * triangle];
      const glm::dvec3 e1(primitive.positions[corner[1]] - primitive.positions[corner[0]]);
      const glm::dvec3 e2(primitive.positions[corner[2]] - primitive.positions[corner[0]]);
      const glm::dvec2 t1(primitive.texcoords[corner[1]] - primitive.texcoords[corner[0]]);
      const glm::dvec2 t2(primitive.texcoords[corner[2]] - primitive.texcoords[corner[0]]);
      const double determinant = t1.x * t2.y - t2.x * t1.y;
      ASSERT_NE(determinant, 0.0) << primitive.name;
      const glm::dvec3 alongU = (e1 * t2.y - e2 * t1.y) / determinant;
      const glm::dvec3 alongV = (e2 * t1.x - e1 * t2.x) / determinant;
      const glm::dvec3 normal(primitive.normals[corner[0]]);
      const glm::dvec3 tangent(primitive.tangents[corner[0]]);
      const glm::dvec3 bitangent = glm::cross(normal, tangent) * static_cast<double>(primitive.tangents[corner[0]].w);
      if (!(glm::dot(alongU, tangent) > 0.0 && glm::dot(alongV, bitangent) < 0.0)) ++wrong;
    }
    // Beside a pole a triangle's own u direction may be far from its corner's.
    EXPECT_LE(wrong, primitive.triangleCount() / 100) << primitive.name;
  }
}

TEST_P(BuiltinScene, EveryVertexIsUsed) {
  const Scene scene = builtinScene(GetParam());
  for (const Primitive& primitive : scene.primitives) {
    const std::set<std::uint32_t> used(primitive.indices.begin(), primitive.indices.end());
    EXPECT_EQ(used.size(), primitive.positions.size()) << primitive.name;
  }
}

TEST(BuiltinOrnament, IsOfTheSizeThatWasAskedFor) {
  const Scene scene = builtinScene("builtin:ornament");
  EXPECT_GE(scene.vertexCount(), 35000u);
  EXPECT_LE(scene.vertexCount(), 55000u);
  const Bounds bounds = boundsOf(scene);
  EXPECT_NEAR(bounds.upper.x - bounds.lower.x, 4.1f, 0.05f);
  bool rough = false;
  bool anisotropic = false;
  bool normalMapped = false;
  for (const Material& material : scene.materials) {
    rough |= material.metallicRoughnessTexture != kNone;
    anisotropic |= material.anisotropyStrength > 0.5f && material.anisotropyTexture != kNone;
    normalMapped |= material.normalTexture != kNone;
  }
  EXPECT_TRUE(rough && anisotropic && normalMapped);
}

TEST(BuiltinOrnament, TexturesDecodeAndRepeatWithoutASeam) {
  const Scene scene = builtinScene("ornament");
  for (const EncodedImage& encoded : scene.images) {
    const Image8 image = decodeImage8(encoded.bytes, encoded.name);
    ASSERT_GE(image.width, 128);
    // Across the seam neighbouring texels may differ no more than they do anywhere else.
    int within = 0;
    int across = 0;
    const auto at = [&](int x, int y, int c) {
      return static_cast<int>(
          image.texels[4 * (static_cast<std::size_t>(y % image.height) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x % image.width)) +
                       static_cast<std::size_t>(c)]);
    };
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          const int right = std::abs(at(x + 1, y, c) - at(x, y, c));
          const int below = std::abs(at(x, y + 1, c) - at(x, y, c));
          int& horizontal = x + 1 == image.width ? across : within;
          int& vertical = y + 1 == image.height ? across : within;
          horizontal = std::max(horizontal, right);
          vertical = std::max(vertical, below);
        }
      }
    }
    EXPECT_LE(across, within) << encoded.name;
  }
}

/// The floor's, plinth's and pillars' edges that meet must do so: an edge of the floor that borders on nothing lies on a pillar's foot, on
/// the plinth's foot or on the slab's edge.
TEST(BuiltinOrnament, TheFloorMeetsWhatStandsOnIt) {
  const Scene scene = builtinScene("ornament");
  std::map<std::array<float, 3>, int> feet;
  for (const Primitive& primitive : scene.primitives) {
    if (primitive.name == "floor") continue;
    for (const glm::vec3& p : primitive.positions) {
      if (p.y == 0.0f) feet[{std::round(p.x * 1e5f), 0.0f, std::round(p.z * 1e5f)}]++;
    }
  }
  const Primitive& floor = scene.primitives.front();
  ASSERT_EQ(floor.name, "floor");
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < floor.indices.size(); ++i) {
    const std::uint32_t a = floor.indices[i];
    const std::uint32_t b = floor.indices[i % 3 == 2 ? i - 2 : i + 1];
    edges[{std::min(a, b), std::max(a, b)}]++;
  }
  int atPillars = 0;
  int atPlinth = 0;
  for (const auto& [edge, count] : edges) {
    ASSERT_LE(count, 2);
    if (count == 2) continue;
    for (const std::uint32_t index : {edge.first, edge.second}) {
      const glm::vec3 p = floor.positions[index];
      const float radius = glm::length(glm::vec2(p.x, p.z));
      if (p.y != 0.0f || radius > 1.99f) continue;  // the slab's own edge
      if (radius < 0.65f) {
        ++atPlinth;
        continue;
      }
      ++atPillars;
      bool found = false;
      for (float dx = -1.0f; dx <= 1.0f && !found; ++dx) {  // neighbours: rounding may fall on either side
        for (float dz = -1.0f; dz <= 1.0f && !found; ++dz)
          found = feet.contains({std::round(p.x * 1e5f) + dx, 0.0f, std::round(p.z * 1e5f) + dz});
      }
      EXPECT_TRUE(found) << p.x << " " << p.z;
    }
  }
  EXPECT_EQ(atPillars, 2 * 8 * 48);
  EXPECT_EQ(atPlinth, 2 * 256);
}

TEST(BuiltinScenes, UnknownNamesAreErrors) {
  EXPECT_THROW(builtinScene("builtin:teapot"), Error);
  EXPECT_TRUE(isBuiltinName("builtin:sphere"));
  EXPECT_FALSE(isBuiltinName("sphere.glb"));
}

}  // namespace
}  // namespace chiaro
