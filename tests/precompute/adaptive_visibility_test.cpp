// Visibility traced only where it changes, against tracing every direction.
#include "precompute/visibility/adaptive_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "assets/builtin/builtin_scene.h"
#include "precompute/bake.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/transfer_rows.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

std::vector<SphereBoards> boardsOfManyKinds() {
  std::vector<SphereBoards> result;
  for (const int resolution : {8, 16, 24}) {
    result.emplace_back(resolution);
    result.push_back(SphereBoards::finer(SphereBoards::finer(result.back())));
  }
  return result;
}

TEST(SphereBoardsTest, WhatIsBesideIsWhatTheGridSays) {
  std::mt19937_64 random(3);
  for (const auto& boards : boardsOfManyKinds()) {
    const OctahedralGrid grid(boards.resolution);
    std::vector<Board> bits(boards.boardCount), back;
    for (auto& word : bits) word = random();
    TexelBits texels;
    boards.toTexels(bits, texels);
    boards.fromTexels(texels, back);
    EXPECT_EQ(back, bits);
    for (std::size_t b = 0; b < boards.boardCount; ++b) {
      const auto around8 = boards.around8(bits.data(), b);
      for (std::size_t bit = 0; bit < 64; ++bit) {
        const auto texel = 16 * std::size_t{boards.tile[4 * b + bit / 16]} + bit % 16;
        ASSERT_EQ(grid.direction(texel), glm::vec3(boards.x[64 * b + bit], boards.y[64 * b + bit], boards.z[64 * b + bit]));
        const auto expect = [&](SphereBoards::Side side, int dx, int dy) {
          ASSERT_EQ(boards.at(bits.data(), b, side) >> bit & 1, Board{texelBit(texels.data(), grid.texelBeside(texel, dx, dy))});
        };
        expect(SphereBoards::left, -1, 0);
        expect(SphereBoards::right, 1, 0);
        expect(SphereBoards::top, 0, -1);
        expect(SphereBoards::bottom, 0, 1);
        bool any = false;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) any = any || texelBit(texels.data(), grid.texelBeside(texel, dx, dy));
        ASSERT_EQ((around8 >> bit & 1) != 0, any);
      }
    }
  }
}

TEST(SphereBoardsTest, AboveIsWhatTheGridSays) {
  std::mt19937 random(4);
  std::normal_distribution<float> gaussian;
  for (const auto& boards : boardsOfManyKinds()) {
    const OctahedralGrid grid(boards.resolution);
    AlignedFloats cosine(grid.texelCount);
    TexelBits expected, above;
    std::vector<Board> bits;
    for (int i = 0; i < 20; ++i) {
      const auto n = i < 3 ? glm::vec3(i == 0, i == 1, i == 2) : glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random)));
      texelsAbove(grid, n, cosine, expected);
      boards.above(n, bits);
      boards.toTexels(bits, above);
      ASSERT_EQ(above, expected);
    }
  }
}

TEST(SphereBoardsTest, DoubledTexelsAreFour) {
  const SphereBoards coarse(16), fine = SphereBoards::finer(coarse);
  const OctahedralGrid coarseGrid(16), fineGrid(32);
  std::mt19937_64 random(5);
  std::vector<Board> bits(coarse.boardCount), fineBits(fine.boardCount);
  for (auto& word : bits) word = random();
  for (std::size_t b = 0; b < fine.boardCount; ++b) fineBits[b] = doubled(static_cast<std::uint16_t>(bits[b / 4] >> 16 * (b % 4)));
  TexelBits texels, fineTexels;
  coarse.toTexels(bits, texels);
  fine.toTexels(fineBits, fineTexels);
  for (std::size_t t = 0; t < fineGrid.texelCount; ++t) {
    const auto row = fineGrid.rowMajor[t] / 32, column = fineGrid.rowMajor[t] % 32;
    ASSERT_EQ(texelBit(fineTexels.data(), t), texelBit(texels.data(), coarseGrid.tiled[row / 2 * 16 + column / 2]));
  }
}

TEST(SphereBoardsTest, SparseTexelsMeetEveryRowAndColumn) {
  const SphereBoards boards(8);
  TexelBits texels;
  boards.toTexels({SphereBoards::sparse()}, texels);
  const OctahedralGrid grid(8);
  int rows[8] = {}, columns[8] = {};
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    if (!texelBit(texels.data(), t)) continue;
    ++rows[grid.rowMajor[t] / 8];
    ++columns[grid.rowMajor[t] % 8];
  }
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(rows[i] == 1 && columns[i] == 1) << i;
}

Scene doubleSided(Scene scene) {
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  for (auto& primitive : scene.primitives) primitive.material = 0;
  return scene;
}

/// Texels that differ from tracing all, in parts of the map, over all vertices.
double differingShare(const Scene& scene, int coarse, int sampling, double* rayShare = nullptr) {
  const RayScene rays(scene);
  const AdaptiveSphere sphere(coarse, sampling);
  AdaptiveVisibility adaptive(rays, sphere);
  const OctahedralGrid grid(sampling);
  AlignedFloats cosine(grid.texelCount);
  TexelBits above, visible;
  std::size_t different = 0;
  std::uint64_t some = 0, all = 0;
  const auto viewpoints = viewpointsOf(scene, rays);
  for (const auto& viewpoint : viewpoints) {
    texelsAbove(grid, viewpoint.normal, cosine, above);
    all += traceVisibility(rays, grid, viewpoint, above, visible);
    some += adaptive(viewpoint);
    EXPECT_EQ(adaptive.above(), above);
    for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
      const unsigned asked = viewpoint.doubleSided ? 0xffffu : above[tile];
      EXPECT_EQ(adaptive.visible()[tile] & ~asked, 0u);
      different += static_cast<std::size_t>(std::popcount((adaptive.visible()[tile] ^ visible[tile]) & asked));
    }
  }
  if (rayShare != nullptr) *rayShare = static_cast<double>(some) / static_cast<double>(all);
  return static_cast<double>(different) / static_cast<double>(viewpoints.size() * grid.texelCount);
}

/// No box is narrower than a coarse texel as a whole: only tips of corners between coarse texels may be missed.
constexpr double kTips = 5e-5;

TEST(AdaptiveVisibilityTest, AtOneLevelItIsFullTracing) {
  for (const auto& scene : {boxesOnFloor(), doubleSided(boxesOnFloor())}) EXPECT_EQ(differingShare(scene, 32, 32), 0.0);
}

TEST(AdaptiveVisibilityTest, ALowShareOfRaysSeesTheSame) {
  double share = 1.0;
  for (const auto& scene : {boxesOnFloor(), doubleSided(boxesOnFloor())}) {
    EXPECT_LE(differingShare(scene, 32, 128, &share), kTips);
    EXPECT_LE(share, 0.2);
  }
  EXPECT_LE(differingShare(sceneWith({floorGrid(1.0f, 2), capDisc({0.4f, 0.7f, -0.3f}, 0.35f, 5.0f)}), 16, 256, &share), kTips);
  EXPECT_LE(share, 0.1);
}

TEST(AdaptiveVisibilityTest, OpenSkyCostsItsCoarseRaysAndTheHorizon) {
  double share = 1.0;
  EXPECT_EQ(differingShare(sceneWith({floorGrid(1.0f, 2)}), 32, 256, &share), 0.0);
  EXPECT_LE(share, 1.0 / 64.0 + 0.02);
}

/// A room without windows, seen from inside.
TEST(AdaptiveVisibilityTest, InsideABoxAllIsHidden) {
  Primitive room = standingBox({0, 0}, 1.0f, 2.0f, 2);
  addGrid(room, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, 2);
  for (auto& n : room.normals) n = -n;
  for (std::size_t i = 0; i < room.indices.size(); i += 3) std::swap(room.indices[i + 1], room.indices[i + 2]);
  EXPECT_EQ(differingShare(sceneWith({room}), 16, 128), 0.0);
}

/// Two walls a slit apart over a floor: from the floor beside it a line of light, from its bottom all that is seen.
Scene slit(float width) {
  Primitive near, far;
  addGrid(near, {-50.0f - 0.5f * width, 2, 50}, {50, 0, 0}, {0, 0, -100}, 1);
  addGrid(far, {0.5f * width, 2, 50}, {50, 0, 0}, {0, 0, -100}, 1);
  return sceneWith({floorGrid(1.0f, 4), near, far});
}

TEST(AdaptiveVisibilityTest, AThinSlitIsFollowedToItsEnds) {
  // Overhead it is a twentieth or a hundredth of a radian wide, a coarse texel or a quarter; it narrows with the square of the sine of its
  // elevation, and where it is narrower than a fine texel it breaks up into lone ones that nothing leads to.
  constexpr double kFarEnds = 5e-4, kFarEndsOfThin = 2e-3;
  EXPECT_LE(differingShare(slit(0.1f), 64, 256), kFarEnds);
  EXPECT_LE(differingShare(slit(0.02f), 64, 256), kFarEndsOfThin);
}

/// A wide floor with low walls at its far ends, lower than a coarse texel: nothing but the horizon's own texels meets them.
TEST(AdaptiveVisibilityTest, WhatIsLowOnTheHorizonIsFollowed) {
  Primitive wall;
  addGrid(wall, {-40, 0, -30}, {80, 0, 0}, {0, 0.6f, 0}, 1);
  addGrid(wall, {30, 0, -20}, {0, 0, 20}, {0, 1.0f, 0}, 1);
  // All of the horizon traced leaves 1.0e-4 (the tops of the walls end between texels), none of it 3.0e-3.
  EXPECT_LE(differingShare(sceneWith({floorGrid(1.0f, 4), wall}), 32, 256), 3e-4);
}

TEST(AdaptiveVisibilityTest, HardlyDependsOnScale) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) EXPECT_LE(differingShare(scaled(boxesOnFloor(), scale), 32, 128), kTips) << scale;
}

TEST(AdaptiveVisibilityTest, OfTheBuiltInScene) {
  RepairReport report;
  const auto scene = prepareScene(builtinScene("ornament"), 1.0472f, report);
  const RayScene rays(scene);
  const auto viewpoints = viewpointsOf(scene, rays);
  const AdaptiveSphere sphere(64, 256), everything(256, 256);
  AdaptiveVisibility adaptive(rays, sphere), full(rays, everything);
  std::size_t different = 0, count = 0;
  for (std::size_t v = 0; v < viewpoints.size(); v += viewpoints.size() / 100, ++count) {
    adaptive(viewpoints[v]);
    full(viewpoints[v]);
    for (std::size_t tile = 0; tile < full.visible().size(); ++tile)
      different += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(full.visible()[tile] ^ adaptive.visible()[tile])));
  }
  EXPECT_LE(static_cast<double>(different), 1e-4 * static_cast<double>(count) * 256 * 256);
}

TEST(AdaptiveVisibilityTest, CoarserLevelsAreTracedThroughTheirOwnCentres) {
  for (const auto& scene : {boxesOnFloor(), doubleSided(boxesOnFloor())}) {
    const RayScene rays(scene);
    const AdaptiveSphere sphere(32, 128);
    AdaptiveVisibility adaptive(rays, sphere);
    for (const int resolution : {32, 64, 128}) {
      const OctahedralGrid grid(resolution);
      AlignedFloats cosine(grid.texelCount);
      TexelBits above, visible, storedAbove, stored;
      std::size_t different = 0, total = 0;
      for (const auto& viewpoint : viewpointsOf(scene, rays)) {
        adaptive(viewpoint);
        adaptive.at(resolution, storedAbove, stored);
        texelsAbove(grid, viewpoint.normal, cosine, above);
        traceVisibility(rays, grid, viewpoint, above, visible);
        ASSERT_EQ(above, storedAbove);
        for (std::size_t tile = 0; tile < grid.tileCount; ++tile)
          different += static_cast<std::size_t>(std::popcount((stored[tile] ^ visible[tile]) & (viewpoint.doubleSided ? 0xffffu : above[tile])));
        total += grid.texelCount;
      }
      // The level between is not traced: its edges are those of the sampling texels about its centres, half of one off.
      EXPECT_LE(static_cast<double>(different), (resolution == 64 ? 1e-2 : 5e-5) * static_cast<double>(total)) << resolution;
    }
    TexelBits above, visible;
    EXPECT_THROW(adaptive.at(48, above, visible), std::invalid_argument);
  }
}

TEST(AdaptiveVisibilityTest, ResolutionsMustFit) {
  EXPECT_THROW(AdaptiveSphere(20, 40), std::invalid_argument);
  EXPECT_THROW(AdaptiveSphere(32, 96), std::invalid_argument);
  EXPECT_NO_THROW(AdaptiveSphere(24, 96));
}

glm::vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> gaussian;
  return glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random)));
}

TEST(ConservativeTest, NoDiscFallsBetweenTexels) {
  std::mt19937 random(6);
  for (const int resolution : {16, 32, 64}) {
    const OctahedralGrid grid(resolution);
    const double radius = coveringRadius(resolution);
    double worst = 0.0;
    for (int i = 0; i < 30000; ++i) {
      // Anywhere, and near the middle of a face, where texels are largest.
      auto w = randomDirection(random);
      if (i % 2 == 0) w = glm::normalize(w * 0.2f + glm::sign(randomDirection(random)));
      const auto home = grid.texelAt(w);
      float chord = 2.0f;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) chord = std::min(chord, glm::distance(w, grid.direction(grid.texelBeside(home, dx, dy))));
      worst = std::max(worst, 2.0 * std::asin(0.5 * static_cast<double>(chord)));
    }
    EXPECT_LE(worst, radius + 1e-6) << resolution;
    EXPECT_GE(worst, 0.9 * radius) << resolution << ": no more than it must be";
  }
  for (const double angle : {0.3, 0.1, 0.05}) {
    const AdaptiveSphere sphere(16, 128, angle);
    EXPECT_LE(coveringRadius(sphere.levels[sphere.first].resolution), 0.5 * angle);
    if (sphere.first > 0) {
      EXPECT_GT(coveringRadius(sphere.levels[sphere.first - 1].resolution), 0.5 * angle);
    }
  }
  EXPECT_EQ(AdaptiveSphere(16, 128).first, 0u);
  EXPECT_THROW(AdaptiveSphere(16, 128, 0.01), std::invalid_argument);
}

TEST(ConservativeTest, NoOccluderAsWideAsTheAngleIsMissed) {
  std::mt19937 random(7);
  const double angle = 0.09;
  const AdaptiveSphere sphere(16, 256, angle);
  for (int i = 0; i < 300; ++i) {
    auto axis = randomDirection(random);
    axis.y = std::abs(axis.y) + 0.06f;  // wholly above the horizon
    // 256 sides reach 8e-5 less far than the circle between them.
    const auto scene = sceneWith({floorGrid(1.0f, 2), capDisc(axis, 0.5f * static_cast<float>(angle) * 1.0002f, 5.0f)});
    const RayScene rays(scene);
    AdaptiveVisibility adaptive(rays, sphere);
    adaptive({.normal = {0, 1, 0}, .front = {0, 1e-4f, 0}});
    ASSERT_NE(adaptive.visible(), adaptive.above()) << axis.x << " " << axis.y << " " << axis.z;
  }
}

/// A rectangle far above a floor, `width` radians wide or a little more from every vertex of the floor, and four times as long.
Scene bladeAbove(glm::vec3 axis, float width, float turn) {
  constexpr float kDistance = 40.0f;
  const auto a = glm::normalize(axis), right = glm::normalize(glm::cross(a, glm::vec3(0.3f, 0.1f, 1.0f))), up = glm::cross(right, a);
  const float w = 1.04f * kDistance * 2.0f * std::tan(0.5f * width), h = 4.0f * w;
  const auto u = w * (std::cos(turn) * right + std::sin(turn) * up), v = h * (std::cos(turn) * up - std::sin(turn) * right);
  Primitive blade;
  addGrid(blade, kDistance * a - 0.5f * (u + v), u, v, 1);
  return sceneWith({floorGrid(0.5f, 2), blade});
}

TEST(ConservativeTest, ABakeMissesNoBladeAsWideAsItsLeastOccluder) {
  constexpr float kAngle = 0.04f;
  constexpr std::size_t kFloor = 9;
  std::mt19937 random(8);
  std::uniform_real_distribution<float> turn(0.0f, std::numbers::pi_v<float>);
  TransferRows::Layout usual{.resolution = 64, .samplingResolution = 256, .clamp = kMaxDistance, .leastOccluder = 0.0f, .levels = {},
                             .directions = {}, .directionSharpness = 32.0f};
  auto careful = usual, all = usual;
  careful.leastOccluder = kAngle;
  all.leastOccluder = static_cast<float>(2.0 * coveringRadius(256)) * 1.0001f;
  std::size_t missed = 0, missedCarefully = 0;
  for (int i = 0; i < 50; ++i) {
    auto axis = randomDirection(random);
    axis.y = std::abs(axis.y) + 0.3f;  // wholly above the horizon
    const auto scene = bladeAbove(axis, kAngle, turn(random));
    const RayScene rays(scene);
    const auto viewpoints = viewpointsOf(scene, rays);
    std::vector<std::uint32_t> floor;
    for (std::uint32_t v = 0; v < kFloor; ++v) floor.push_back(v);
    const auto traced = [&](const TransferRows::Layout& layout) {
      const TransferRows rows(rays, viewpoints, layout);
      std::vector<float> values(kFloor * rows.size());
      rows(floor, values.data(), rows.size());
      return values;
    };
    const auto some = traced(usual), most = traced(careful), every = traced(all);
    const auto size = every.size() / kFloor;
    for (std::size_t v = 0; v < kFloor; ++v) {
      const auto open = [&](const std::vector<float>& rows) {
        return std::all_of(rows.begin() + static_cast<std::ptrdiff_t>(v * size), rows.begin() + static_cast<std::ptrdiff_t>((v + 1) * size),
                           [](float s) { return std::abs(s) >= kMaxDistance; });
      };
      ASSERT_FALSE(open(every));
      missed += open(some);
      missedCarefully += open(most);
    }
    // Nor is any part of it lost at 64 x 64, which is coarser than what is traced throughout.
    EXPECT_EQ(most, every) << i;
  }
  EXPECT_EQ(missedCarefully, 0u);
  EXPECT_GT(missed, 0u) << "else the test shows nothing";
}

}  // namespace
}  // namespace chiaro
