// What vertices see, where geometry says what they must see.
#include "precompute/visibility/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "precompute/visibility/fractions.h"
#include "shaders/cpp/lobe.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

struct Seen {
  AlignedFloats cosine;
  TexelBits above, visible;
  std::uint64_t rays = 0;
};

Seen look(const RayScene& rays, const OctahedralGrid& grid, const Viewpoint& viewpoint) {
  Seen seen;
  seen.cosine = AlignedFloats(grid.texelCount);
  texelsAbove(grid, viewpoint.normal, seen.cosine, seen.above);
  seen.rays = traceVisibility(rays, grid, viewpoint, seen.above, seen.visible);
  return seen;
}

/// Index, over the whole scene, of the vertex of primitive `p` nearest to `position`.
std::size_t vertexNear(const Scene& scene, std::size_t p, glm::vec3 position) {
  std::size_t first = 0, best = 0;
  for (std::size_t i = 0; i < p; ++i) first += scene.primitives[i].positions.size();
  const auto& positions = scene.primitives[p].positions;
  for (std::size_t i = 1; i < positions.size(); ++i)
    if (glm::distance(positions[i], position) < glm::distance(positions[best], position)) best = i;
  return first + best;
}

TEST(OctahedralGridTest, TilesAndNeighboursCoverTheSphereOnce) {
  for (const int resolution : {16, 20, 64}) {
    const OctahedralGrid grid(resolution);
    double solidAngle = 0.0;
    for (std::size_t t = 0; t < grid.texelCount; ++t) {
      solidAngle += static_cast<double>(grid.solidAngle[t]);
      ASSERT_EQ(grid.tiled[grid.rowMajor[t]], t);
      ASSERT_EQ(grid.texelAt(grid.direction(t)), t);
      const lobe64::IVec2 at(static_cast<int>(grid.rowMajor[t]) % resolution, static_cast<int>(grid.rowMajor[t]) / resolution);
      ASSERT_LE(glm::length(glm::dvec3(grid.direction(t)) - lobe64::octahedralTexelDirection(at, resolution)), 1e-7);
    }
    EXPECT_LE(std::abs(solidAngle - 4.0 * std::numbers::pi), 1e-4) << "float rounding of each texel";
    // Four edges a texel, each shared by two; at the middle of each border side two texels share two edges, kept once.
    EXPECT_EQ(grid.neighbours.size(), 2 * grid.texelCount - 4);
    std::set<std::pair<std::uint32_t, std::uint32_t>> unique;
    for (const auto& [a, b] : grid.neighbours) {
      EXPECT_TRUE(unique.insert(std::minmax(a, b)).second);
      // The square is stretched by at most 2 sqrt(6) / resolution a texel (in the middle of a face, along its long diagonal).
      EXPECT_LE(glm::distance(grid.direction(a), grid.direction(b)), 4.9f / static_cast<float>(resolution));
    }
  }
}

TEST(OctahedralGridTest, BilinearValuesAreContinuousAcrossTheBorder) {
  const OctahedralGrid grid(64);
  std::vector<float> map(grid.texelCount);
  for (std::size_t t = 0; t < grid.texelCount; ++t) map[grid.rowMajor[t]] = glm::dot(grid.direction(t), glm::vec3(0.3f, -0.5f, 0.8f));
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  float worst = 0.0f;
  for (int i = 0; i < 20000; ++i) {
    const auto w = glm::normalize(glm::vec3(normal(random), normal(random), normal(random) - 1.0f));
    worst = std::max(worst, std::abs(sampleOctahedral(map.data(), 64, w) - glm::dot(w, glm::vec3(0.3f, -0.5f, 0.8f))));
  }
  // The map bends sharply along its folds: there up to a quarter of a texel (4.9 / 64) of slope 1 is lost.
  EXPECT_LE(worst, 0.25f * 4.9f / 64.0f);
}

TEST(Visibility, AnOpenPlaneSeesEverything) {
  const auto scene = sceneWith({floorGrid(3.0f, 6)});
  const RayScene rays(scene);
  const OctahedralGrid grid(32);
  for (const auto& viewpoint : viewpointsOf(scene, rays)) {
    const auto seen = look(rays, grid, viewpoint);
    std::uint64_t above = 0;
    for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
      EXPECT_EQ(seen.visible[tile], 0xffffu);
      above += static_cast<std::uint64_t>(std::popcount(seen.above[tile]));
    }
    EXPECT_EQ(seen.rays, above) << "no ray below the horizon";
  }
}

TEST(Visibility, ADiscHidesItsCone) {
  const glm::vec3 axis = glm::normalize(glm::vec3(0.4f, 0.7f, -0.3f));
  const float radius = 0.35f;
  const auto scene = sceneWith({floorGrid(1.0f, 2), capDisc(axis, radius, 5.0f)});
  const RayScene rays(scene);
  const OctahedralGrid grid(64);
  const auto seen = look(rays, grid, viewpointsOf(scene, rays)[vertexNear(scene, 0, glm::vec3(0.0f))]);
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    if (!texelBit(seen.above.data(), t)) continue;
    const float angle = std::acos(glm::dot(grid.direction(t), axis));
    // The polygon of 256 sides and the offset of the ray leave 1e-3 undecided.
    if (std::abs(angle - radius) > 1e-3f) { EXPECT_EQ(texelBit(seen.visible.data(), t), angle > radius) << angle; }
  }
}

TEST(Visibility, BelowTheHorizonIsTheMirrorImage) {
  const auto scene = sceneWith({floorGrid(1.0f, 2), capDisc({0.4f, 0.7f, -0.3f}, 0.35f, 5.0f)});
  const RayScene rays(scene);
  const OctahedralGrid grid(64);
  const auto viewpoint = viewpointsOf(scene, rays)[vertexNear(scene, 0, glm::vec3(0.0f))];
  const auto seen = look(rays, grid, viewpoint);
  std::size_t below = 0, equal = 0;
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    if (texelBit(seen.above.data(), t)) continue;
    const auto w = grid.direction(t);
    const auto mirrored = w - 2.0f * glm::dot(w, viewpoint.normal) * viewpoint.normal;
    ++below;
    equal += texelBit(seen.visible.data(), t) == !rays.occluded(viewpoint.front, mirrored, 0.0f, 100.0f);
  }
  // The nearest texel decides, so only the disc's rim may differ: its length times half a texel, in parts of the half sphere.
  EXPECT_GE(static_cast<double>(equal), static_cast<double>(below) * (1.0 - 2.0 * 0.35 * 0.03));
}

/// Every traced texel of vertex `vertex` of `scene` must see exactly where `expected` says so, but for directions within `slack` of its
/// edge (expected returns a signed sine).
template <typename Expected>
void expectSees(const Scene& scene, std::size_t vertex, const Expected& expected, float slack = 1e-3f) {
  const RayScene rays(scene);
  const OctahedralGrid grid(32);
  const auto viewpoint = viewpointsOf(scene, rays)[vertex];
  const auto seen = look(rays, grid, viewpoint);
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    const auto w = grid.direction(t);
    if (!viewpoint.doubleSided && !texelBit(seen.above.data(), t)) continue;
    const float side = expected(w);
    if (std::abs(side) > slack) {
      EXPECT_EQ(texelBit(seen.visible.data(), t), side > 0.0f) << w.x << " " << w.y << " " << w.z;
    }
  }
}

/// A floor for x > 0 and a wall for y > 0 that share the edge x = y = 0, both 200 units wide.
Scene corner() {
  Primitive floor, wall;
  addGrid(floor, {0, 0, 100}, {100, 0, 0}, {0, 0, -200}, 2);
  addGrid(wall, {0, 0, -100}, {0, 100, 0}, {0, 0, 200}, 2);
  for (auto& n : wall.normals) n = {1, 0, 0};
  for (std::size_t i = 0; i < wall.indices.size(); i += 3) std::swap(wall.indices[i + 1], wall.indices[i + 2]);
  return sceneWith({floor, wall});
}

TEST(Visibility, AVertexInACornerIsInFrontOfTheOtherWall) {
  for (const float scale : {1e-3f, 1e-2f, 1.0f, 100.0f}) {
    for (const glm::vec3 shift : {glm::vec3(0.0f), glm::vec3(30, -20, 50)}) {
      SCOPED_TRACE(scale);
      const auto scene = scaled(corner(), scale, scale * shift);
      // The wall ends 100 units above: to see over it a direction would have to be within 1e-3 of it.
      expectSees(scene, vertexNear(scene, 0, scale * shift), [](glm::vec3 w) { return w.x; }, 0.01f);
      expectSees(scene, vertexNear(scene, 1, scale * shift), [](glm::vec3 w) { return w.y; }, 0.01f);
    }
  }
}

TEST(Visibility, AVertexOfADoubleSidedCornerToo) {
  auto scene = corner();
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  for (auto& primitive : scene.primitives) primitive.material = 0;
  // Behind the floor there is nothing (the wall stands on it, so below the horizon all is open).
  expectSees(scene, vertexNear(scene, 0, glm::vec3(0.0f)), [](glm::vec3 w) { return w.y < 0.0f ? 1.0f : w.x; }, 0.01f);
}

TEST(Visibility, TheFootOfABoxDoesNotSeeUnderTheFloor) {
  // No vertex of the floor is where the box stands, so nothing but the ray's origin says on which side it is.
  const auto scene = sceneWith({floorGrid(500.0f, 1), standingBox({0.3f, 0.2f}, 0.5f, 1.0f, 2)});
  for (const float z : {0.7f, 0.2f}) {
    expectSees(scene, vertexNear(scene, 1, {0.8f, 0, z}), [](glm::vec3 w) { return w.y; }, 0.01f);
  }
}

TEST(Visibility, SmoothConcaveBottomSeesTheOpening) {
  // A bowl: the lower half of a sphere seen from inside, its bottom vertex sees the cone through the rim.
  Primitive bowl;
  const int rings = 24, segments = 48;
  bowl.positions.push_back({0, -1, 0});
  for (int r = 1; r <= rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double theta = 0.5 * std::numbers::pi * r / rings, phi = 2.0 * std::numbers::pi * s / segments;
      bowl.positions.push_back(glm::vec3(std::sin(theta) * std::cos(phi), -std::cos(theta), std::sin(theta) * std::sin(phi)));
    }
  const auto at = [&](int r, int s) { return r == 0 ? 0u : static_cast<std::uint32_t>(1 + (r - 1) * segments + s % segments); };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      if (r > 0) bowl.indices.insert(bowl.indices.end(), {at(r, s), at(r, s + 1), at(r + 1, s)});
      bowl.indices.insert(bowl.indices.end(), {at(r + 1, s), r > 0 ? at(r, s + 1) : at(0, 0), at(r + 1, s + 1)});
    }
  for (const auto& p : bowl.positions) bowl.normals.push_back(-p);
  const auto scene = sceneWith({bowl});
  // The rim is at 45 degrees from the bottom; a polygon of 48 sides reaches in by .2 %.
  expectSees(scene, 0, [](glm::vec3 w) { return w.y - std::sqrt(0.5f); }, 0.01f);
}

TEST(Visibility, HardlyDependsOnScaleOrPlace) {
  const auto original = boxesOnFloor();
  const OctahedralGrid grid(32);
  const RayScene rays(original);
  const auto viewpoints = viewpointsOf(original, rays);
  for (const float scale : {1e-3f, 0.0625f, 37.0f, 1e4f}) {
    const auto other = scaled(original, scale);
    const RayScene otherRays(other);
    const auto otherViewpoints = viewpointsOf(other, otherRays);
    std::size_t different = 0, total = 0;
    for (std::size_t v = 0; v < viewpoints.size(); ++v) {
      const auto a = look(rays, grid, viewpoints[v]), b = look(otherRays, grid, otherViewpoints[v]);
      for (std::size_t tile = 0; tile < grid.tileCount; ++tile)
        different += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(a.visible[tile] ^ b.visible[tile])));
      total += grid.texelCount;
    }
    // A power of two changes no mantissa; any other factor moves edges by rounding, which only a ray through an edge can notice.
    const double share = static_cast<double>(different) / static_cast<double>(total);
    EXPECT_LE(share, scale == 0.0625f ? 0.0 : 1e-3) << scale;
  }
}

TEST(VisibleFractionsTest, DirectionsAreEvenlySpread) {
  for (const int count : {8, 32, 64}) {
    const auto directions = fibonacciDirections(count);
    ASSERT_EQ(directions.size(), static_cast<std::size_t>(count));
    glm::dvec3 sum(0.0);
    for (const auto& d : directions) {
      EXPECT_LE(std::abs(glm::length(d) - 1.0f), 1e-6f);
      sum += glm::dvec3(d);
    }
    EXPECT_LE(glm::length(sum), 0.1 * count) << "no side is favoured";
    EXPECT_LE(std::abs(directions[0].z - (1.0f - 1.0f / static_cast<float>(count))), 1e-6f);
  }
}

/// v_j by its definition in double, from the bits.
double fractionByDefinition(const OctahedralGrid& grid, const Viewpoint& viewpoint, const TexelBits& visible, glm::vec3 axis, double sharpness) {
  double all = 0.0, seen = 0.0;
  const bool front = glm::dot(viewpoint.normal, axis) > 0.0f || !viewpoint.doubleSided;
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    const glm::dvec3 w(grid.direction(t));
    const double cosine = glm::dot(w, glm::dvec3(viewpoint.normal));
    if ((cosine > 0.0) != front) continue;
    const double weight = static_cast<double>(grid.solidAngle[t]) * std::abs(cosine) * std::exp(sharpness * (glm::dot(w, glm::dvec3(axis)) - 1.0));
    all += weight;
    if (texelBit(visible.data(), t)) seen += weight;
  }
  return seen / all;
}

TEST(VisibleFractionsTest, AreTheLobesShareOfWhatArrives) {
  const auto directions = fibonacciDirections(32);
  const OctahedralGrid grid(32);
  const VisibleFractions fractionsOf(grid, directions, 32.0f);
  for (const bool doubleSided : {false, true}) {
    auto scene = boxesOnFloor();
    scene.materials.resize(1);
    scene.materials[0].doubleSided = doubleSided;
    for (auto& primitive : scene.primitives) primitive.material = 0;
    const RayScene rays(scene);
    for (const auto& viewpoint : viewpointsOf(scene, rays)) {
      const auto seen = look(rays, grid, viewpoint);
      std::vector<float> fractions(32, -1.0f);
      fractionsOf(viewpoint, seen.cosine, seen.above, seen.visible, fractions.data());
      for (std::size_t j = 0; j < directions.size(); ++j) {
        ASSERT_TRUE(fractions[j] >= 0.0f && fractions[j] <= 1.0f);
        if (!doubleSided && glm::dot(directions[j], viewpoint.normal) < -0.2f) continue;  // hardly above: see the next test
        EXPECT_LE(std::abs(static_cast<double>(fractions[j]) - fractionByDefinition(grid, viewpoint, seen.visible, directions[j], 32.0)), 1e-4);
      }
    }
  }
}

TEST(VisibleFractionsTest, ALobeBelowTheHorizonTakesItsMirrorImage) {
  // A wall hides x < 0: axes below the horizon on that side must say "hidden", on the other "seen".
  auto scene = corner();
  const RayScene rays(scene);
  const OctahedralGrid grid(32);
  const auto directions = fibonacciDirections(32);
  const auto viewpoint = viewpointsOf(scene, rays)[vertexNear(scene, 0, glm::vec3(0.0f))];
  const auto seen = look(rays, grid, viewpoint);
  std::vector<float> fractions(32);
  VisibleFractions(grid, directions, 32.0f)(viewpoint, seen.cosine, seen.above, seen.visible, fractions.data());
  for (std::size_t j = 0; j < 32; ++j) {
    if (directions[j].x < -0.5f) { EXPECT_LE(fractions[j], 0.1f) << j; }
    if (directions[j].x > 0.5f) { EXPECT_GE(fractions[j], 0.9f) << j; }
  }
}

}  // namespace
}  // namespace chiaro
