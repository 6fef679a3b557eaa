#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "runtime/environment/cube_map.h"

namespace chiaro {
namespace {

TEST(CubeMap, FacesLookWhereOpenGlSaysTheyDo) {
  const glm::vec3 centres[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::vec3 columns[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  const glm::vec3 rows[] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
  for (int face = 0; face < 6; ++face) {
    EXPECT_EQ(cubeDirection({face, 0, 0}), centres[face]);
    EXPECT_EQ(cubeDirection({face, 1, 0}) - cubeDirection({face, 0, 0}), columns[face]);
    EXPECT_EQ(cubeDirection({face, 0, 1}) - cubeDirection({face, 0, 0}), rows[face]);
  }
}

TEST(CubeMap, CoordinatesInvertDirections) {
  for (int face = 0; face < 6; ++face)
    for (float s : {-0.99f, -0.3f, 0.0f, 0.7f})
      for (float t : {-0.8f, 0.0f, 0.2f, 0.99f}) {
        const CubeCoordinates back = cubeCoordinates(3.7f * cubeDirection({face, s, t}));
        EXPECT_EQ(back.face, face);
        EXPECT_NEAR(back.s, s, 1e-6);  // two roundings
        EXPECT_NEAR(back.t, t, 1e-6);
      }
}

TEST(CubeMap, SolidAnglesCoverTheSphere) {
  for (int resolution : {1, 2, 7, 64}) {
    double sum = 0.0;
    for (int j = 0; j < resolution; ++j)
      for (int i = 0; i < resolution; ++i) sum += 6 * cubeTexelSolidAngle(i, j, resolution);
    EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-10);
  }
}

std::vector<glm::vec3> randomCube(int resolution) {
  std::mt19937 random(3);
  std::vector<glm::vec3> texels(static_cast<std::size_t>(6 * resolution * resolution));
  for (glm::vec3& texel : texels)
    texel = glm::vec3(static_cast<float>(random() % 1000), static_cast<float>(random() % 1000), 1.0f);
  return texels;
}

TEST(CubeMap, LookupAtTexelCentresGivesTheTexel) {
  constexpr int kResolution = 8;
  const std::vector<glm::vec3> texels = randomCube(kResolution);
  std::size_t at = 0;
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < kResolution; ++j)
      for (int i = 0; i < kResolution; ++i, ++at) {
        const glm::vec3 found = sampleCube(texels, kResolution, cubeTexelDirection(face, i, j, kResolution));
        EXPECT_LE(glm::length(found - texels[at]), 0.01f);  // direction rounding 1e-7, times 4 texels a unit, times 1000
      }
}

/// Walking over an edge or around a corner must not jump, whatever is in the texels.
TEST(CubeMap, NoSeamAtEdgesAndCorners) {
  constexpr int kResolution = 8;
  const std::vector<glm::vec3> texels = randomCube(kResolution);
  constexpr float kStep = 1e-5f;
  // Bilinear values change by at most 1000 a texel and axis; a texel is 1/4 of the face coordinate; 4 for both axes and the slant.
  const float largest = 4 * 1000 * kStep * 4;
  int crossings = 0;
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) / static_cast<float>(1 << 23) - 1.0f; };
  for (int k = 0; k < 4000; ++k) {
    glm::vec3 onEdge(uniform(), uniform(), uniform());
    const int axis = k % 3;
    onEdge[axis] = std::copysign(1.0f, onEdge[axis]);
    onEdge[(axis + 1) % 3] = std::copysign(1.0f, onEdge[(axis + 1) % 3]);
    if (k % 5 == 0) onEdge[(axis + 2) % 3] = std::copysign(1.0f, onEdge[(axis + 2) % 3]);  // corner
    glm::vec3 here = onEdge, there = onEdge;
    here[axis] *= 1 + kStep;
    there[(axis + 1) % 3] *= 1 + kStep;
    crossings += cubeCoordinates(here).face != cubeCoordinates(there).face;
    EXPECT_LE(glm::length(sampleCube(texels, kResolution, here) - sampleCube(texels, kResolution, there)), largest)
        << onEdge.x << ' ' << onEdge.y << ' ' << onEdge.z;
  }
  EXPECT_EQ(crossings, 4000);
}

/// Halfway over an edge, the value is the mean of the two texels that share it.
TEST(CubeMap, EdgeIsTheMeanOfItsTwoTexels) {
  constexpr int kResolution = 4;
  std::vector<glm::vec3> texels(6 * kResolution * kResolution, glm::vec3(0.0f));
  texels[0 * 16 + 1 * 4 + 0] = glm::vec3(1.0f);  // +X, column 0 (towards +Z), row 1
  texels[4 * 16 + 1 * 4 + 3] = glm::vec3(3.0f);  // +Z, column 3 (towards +X), row 1
  const glm::vec3 edge(1.0f, 0.25f, 1.0f);       // t = -0.25: the centre of row 1
  EXPECT_NEAR(sampleCube(texels, kResolution, edge).x, 2.0f, 1e-5f);
}

}  // namespace
}  // namespace chiaro
