// Refinement: right where it was not looked at, and the same surface as before.
#include "precompute/mesh/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "assets/error.h"
#include "precompute/bake.h"
#include "precompute/mesh/normals.h"
#include "precompute/mesh/subdivide.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/visibility/visibility.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

constexpr float kE = 0.03f;
constexpr RefineSettings kSettings{.error = kE};

/// A closed box, faces outwards, two triangles each.
Primitive box(glm::vec3 lower, glm::vec3 size) {
  Primitive primitive;
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), upper = lower + size;
  for (const auto& [u, v] : {std::pair{x, y}, {y, z}, {z, x}}) {
    addGrid(primitive, upper, -v, -u, 1);
    primitive.normals.resize(primitive.positions.size());
    addGrid(primitive, lower, v, u, 1);
  }
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const auto* v = &primitive.indices[i];
    const auto n = glm::vec3(triangleNormal(primitive.positions[v[0]], primitive.positions[v[1]], primitive.positions[v[2]]));
    if (glm::dot(n, primitive.positions[v[0]] - 0.5f * (lower + upper)) < 0.0f) std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
    for (int c = 0; c < 3; ++c)
      primitive.normals[v[c]] = glm::dot(n, primitive.positions[v[c]] - 0.5f * (lower + upper)) < 0.0f ? -n : n;
  }
  return primitive;
}

/// A floor of two triangles and a box above it that none of its corners, edge middles or centroids is near to. Everything has texture
/// coordinates and tangents, linear and constant on each face.
Scene boxOverFloor() {
  auto scene = sceneWith({floorGrid(2.0f, 1), box({0.5f, 0.25f, -0.875f}, {0.75f, 0.375f, 0.5f})});
  scene.materials.resize(2);
  for (int p = 0; p < 2; ++p) {
    auto& primitive = scene.primitives[static_cast<std::size_t>(p)];
    primitive.material = p;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const auto at = primitive.positions[v], n = primitive.normals[v];
      primitive.texcoords.emplace_back(0.25f * at.x + 0.5f * at.y, 0.5f * at.z - 0.125f * at.y);
      primitive.tangents.emplace_back(n.y, n.z, n.x, p == 0 ? 1.0f : -1.0f);
    }
  }
  return scene;
}

Scene refined(const Scene& scene, const RefineSettings& settings = kSettings, int threads = 0) {
  RefineReport report;
  return refineScene(scene, settings, threads, report);
}

RefineReport reportOf(const Scene& scene, const RefineSettings& settings = kSettings) {
  RefineReport report;
  refineScene(scene, settings, 0, report);
  return report;
}

double areaOf(const Primitive& primitive) {
  double area = 0.0;
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const auto at = [&](std::size_t c) { return glm::dvec3(primitive.positions[primitive.indices[i + c]]); };
    area += 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
  }
  return area;
}

double leastAngleOf(const Primitive& primitive) {
  double least = 4.0;
  for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
    const auto at = [&](std::size_t c) { return primitive.positions[primitive.indices[i / 3 * 3 + (i + c) % 3]]; };
    least = std::min(least, cornerAngle(at(0), at(1), at(2)));
  }
  return least;
}

/// Edges of one triangle, of which there must be as many metres as the surface has border.
double borderOf(const Scene& scene) {
  const EdgeTable table(scene);
  double border = 0.0;
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.firstSide[e + 1] - table.firstSide[e] == 1) border += table.length[e];
  return border;
}

/// Vertices within an edge of a triangle: where there is one, light comes through.
int tJunctions(const Scene& scene) {
  const EdgeTable table(scene);
  int count = 0;
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto& side = table.sides[table.firstSide[e]];
    const auto& positions = scene.primitives[side.primitive].positions;
    const glm::dvec3 a(positions[side.a]), b(positions[side.b]);
    for (const auto& primitive : scene.primitives)
      for (const auto& position : primitive.positions) {
        const double share = glm::dot(glm::dvec3(position) - a, b - a) / glm::dot(b - a, b - a);
        if (share < 1e-4 || share > 1.0 - 1e-4) continue;
        count += glm::length(glm::mix(a, b, share) - glm::dvec3(position)) < 1e-5 * table.length[e];
      }
  }
  return count;
}

/// The error of interpolation over primitive 0 at random points, by the full-size maps of a bake; sorted.
std::vector<double> errorsAtRandomPoints(const Scene& scene, int points) {
  const RayScene rays(scene);
  const OctahedralGrid grid(64);
  const auto& primitive = scene.primitives[0];
  const auto viewpoints = viewpointsOf(scene, rays);
  SsdfTransform transform(grid, grid);
  AlignedFloats cosine(grid.texelCount);
  TexelBits above, visible;
  std::map<std::uint32_t, std::vector<float>> ssdf;
  const auto ssdfOf = [&](std::uint32_t v) -> const std::vector<float>& {
    auto& map = ssdf[v];
    if (map.empty()) {
      map.resize(grid.texelCount);
      texelsAbove(grid, viewpoints[v].normal, cosine, above);
      traceVisibility(rays, grid, viewpoints[v], above, visible);
      transform(viewpoints[v].normal, viewpoints[v].doubleSided, above, visible, above, visible, map.data());
    }
    return map;
  };
  std::vector<double> cumulative;
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const auto at = [&](std::size_t c) { return primitive.positions[primitive.indices[i + c]]; };
    const double area = 0.5 * static_cast<double>(glm::length(glm::cross(at(1) - at(0), at(2) - at(0))));
    cumulative.push_back(area + (cumulative.empty() ? 0.0 : cumulative.back()));
  }
  std::mt19937 random(1);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
  std::vector<double> errors;
  for (int i = 0; i < points; ++i) {
    const auto triangle = std::upper_bound(cumulative.begin(), cumulative.end(), uniform() * cumulative.back()) - cumulative.begin();
    const auto* v = &primitive.indices[3 * static_cast<std::size_t>(triangle)];
    const double root = std::sqrt(uniform()), second = uniform();
    const glm::vec3 share(1.0 - root, root * (1.0 - second), root * second);
    const std::vector<float>* corner[] = {&ssdfOf(v[0]), &ssdfOf(v[1]), &ssdfOf(v[2])};
    auto viewpoint = viewpoints[v[0]];
    const auto position = share.x * primitive.positions[v[0]] + share.y * primitive.positions[v[1]] + share.z * primitive.positions[v[2]];
    viewpoint.front = position + rays.surfaceOffset(position) * viewpoint.normal;
    texelsAbove(grid, viewpoint.normal, cosine, above);
    traceVisibility(rays, grid, viewpoint, above, visible);
    double wrong = 0.0, all = 0.0;
    for (std::size_t t = 0; t < grid.texelCount; ++t) {
      if (!texelBit(above.data(), t)) continue;
      const auto texel = grid.rowMajor[t];
      const float s = share.x * (*corner[0])[texel] + share.y * (*corner[1])[texel] + share.z * (*corner[2])[texel];
      all += static_cast<double>(grid.solidAngle[t]);
      if ((s > 0.0f) != texelBit(visible.data(), t)) wrong += static_cast<double>(grid.solidAngle[t]);
    }
    errors.push_back(wrong / all);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(Refine, TheShadowIsRightAtPointsThatWereNotLookedAt) {
  constexpr int kPoints = 1000;
  const auto before = errorsAtRandomPoints(boxOverFloor(), kPoints), after = errorsAtRandomPoints(refined(boxOverFloor()), kPoints);
  const auto meanOf = [](const std::vector<double>& errors) {
    double sum = 0.0;
    for (const double e : errors) sum += e / kPoints;
    return sum;
  };
  EXPECT_GE(before.back(), 0.2) << "next to the box, or the test is none";
  EXPECT_LE(meanOf(after), 0.5 * static_cast<double>(kE));
  EXPECT_LE(after[kPoints * 99 / 100], static_cast<double>(kE));
  // The largest error of a triangle need not be where the samples are.
  EXPECT_LE(after.back(), 2.0 * static_cast<double>(kE));
}

TEST(Refine, TheSurfaceStaysTheSame) {
  const auto scene = boxOverFloor(), result = refined(scene);
  ASSERT_EQ(result.primitives.size(), 2u);
  EXPECT_GE(result.primitives[0].triangleCount(), 100u);
  EXPECT_GE(result.primitives[1].triangleCount(), 12u);
  for (std::size_t p = 0; p < 2; ++p) {
    const auto& primitive = result.primitives[p];
    EXPECT_EQ(primitive.material, static_cast<int>(p));
    EXPECT_LE(std::abs(areaOf(primitive) / areaOf(scene.primitives[p]) - 1.0), 1e-6);
    EXPECT_GE(leastAngleOf(primitive), 0.5 * leastAngleOf(scene.primitives[p])) << "Rosenberg and Stenger's bound";
    ASSERT_EQ(primitive.normals.size(), primitive.positions.size());
    ASSERT_EQ(primitive.tangents.size(), primitive.positions.size());
    ASSERT_EQ(primitive.texcoords.size(), primitive.positions.size());
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const auto at = primitive.positions[v], n = primitive.normals[v];
      EXPECT_LE(std::abs(primitive.texcoords[v].x - (0.25f * at.x + 0.5f * at.y)), 1e-6f);
      EXPECT_LE(std::abs(primitive.texcoords[v].y - (0.5f * at.z - 0.125f * at.y)), 1e-6f);
      EXPECT_LE(glm::length(primitive.tangents[v] - glm::vec4(n.y, n.z, n.x, p == 0 ? 1.0f : -1.0f)), 1e-6f);
    }
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
      const auto* v = &primitive.indices[i];
      const auto n = glm::vec3(triangleNormal(primitive.positions[v[0]], primitive.positions[v[1]], primitive.positions[v[2]]));
      for (int c = 0; c < 3; ++c) EXPECT_GE(glm::dot(n, primitive.normals[v[c]]), 0.9999f) << "winding and flatness";
    }
  }
}

TEST(Refine, NoCracks) {
  const auto scene = boxOverFloor(), result = refined(scene);
  EXPECT_LE(std::abs(borderOf(result) - 16.0), 1e-4) << "the floor's; the box is closed though all its edges are creases";
  EXPECT_EQ(tJunctions(result), 0);
}

TEST(Refine, NoCracksBetweenPrimitives) {
  // Half of every surface is of another material; the small box gives the large one something to be split for.
  Scene scene = sceneWith({floorGrid(2.0f, 1), box({-1, 0.25f, -1}, {1, 1, 1}), box({0.25f, 0.5f, -0.75f}, {0.25f, 0.5f, 0.25f})});
  scene.materials.resize(2);
  for (std::size_t p = 0; p < 3; ++p) {
    auto half = scene.primitives[p];
    half.material = 1;
    const auto middle = scene.primitives[p].indices.begin() + static_cast<std::ptrdiff_t>(scene.primitives[p].triangleCount() / 2 * 3);
    half.indices.assign(middle, scene.primitives[p].indices.end());
    scene.primitives[p].indices.erase(middle, scene.primitives[p].indices.end());
    scene.primitives.push_back(half);
  }
  RepairReport repairs;
  scene = prepareScene(scene, 1.0f, repairs);
  const auto result = refined(scene);
  ASSERT_EQ(result.primitives.size(), 6u);
  for (const std::size_t p : {0, 3}) EXPECT_GT(result.primitives[p].triangleCount(), 20u);
  EXPECT_GT(result.primitives[1].triangleCount() + result.primitives[4].triangleCount(), 20u);
  for (std::size_t p = 0; p < 6; ++p) {
    EXPECT_EQ(result.primitives[p].material, scene.primitives[p].material);
    EXPECT_LE(std::abs(areaOf(result.primitives[p]) / areaOf(scene.primitives[p]) - 1.0), 1e-6);
  }
  EXPECT_LE(std::abs(borderOf(result) - 16.0), 1e-4) << "both boxes are closed";
  EXPECT_EQ(tJunctions(result), 0);
}

TEST(Refine, ACrackWouldBeFound) {
  auto scene = boxOverFloor();
  auto& floor = scene.primitives[0];
  const auto middle = static_cast<std::uint32_t>(floor.positions.size());  // of the diagonal, for one of its two triangles
  floor.positions.emplace_back(0.0f);
  const auto a = floor.indices[0], b = floor.indices[1], c = floor.indices[2];
  floor.indices.erase(floor.indices.begin(), floor.indices.begin() + 3);
  for (const auto i : {a, b, middle, b, c, middle}) floor.indices.push_back(i);
  EXPECT_GT(tJunctions(scene), 0);
  EXPECT_GT(borderOf(scene), 17.0);
}

TEST(Refine, NothingOccludedNothingAdded) {
  EXPECT_EQ(reportOf(sceneWith({floorGrid(2.0f, 1)})).verticesAdded, 0u);
  EXPECT_EQ(reportOf(sceneWith({box({0, 0, 0}, {1, 2, 3})})).verticesAdded, 0u);
  // A coarse, smooth ball: its flat triangles are behind the horizon of their interpolated normals, but that is no shadow.
  Primitive ball;
  constexpr int kRings = 6, kSegments = 9;
  for (int j = 0; j <= kRings; ++j)
    for (int i = 0; i <= kSegments; ++i) {
      const float theta = std::numbers::pi_v<float> * static_cast<float>(j) / kRings,
                  phi = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i % kSegments) / kSegments;
      const bool pole = j == 0 || j == kRings;
      ball.positions.push_back(pole ? glm::vec3(0, j == 0 ? 1 : -1, 0) : glm::vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)));
    }
  for (std::uint32_t j = 0; j < kRings; ++j)
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const auto a = j * (kSegments + 1) + i, b = a + kSegments + 1;
      for (const auto index : {a, b, b + 1, a, b + 1, a + 1}) ball.indices.push_back(index);
    }
  ball.normals = ball.positions;
  RepairReport repairs;
  const auto report = reportOf(prepareScene(sceneWith({ball}), 1.0f, repairs));
  EXPECT_EQ(report.verticesAdded, 0u);
  EXPECT_EQ(report.passes, 0);
}

TEST(Refine, AShadowInsideAWallIsFound) {
  // Seen neither from the floor's corners nor from its edges' middles or centroids.
  const auto scene = sceneWith({floorGrid(2.0f, 1), box({1.1f, 0.02f, 0.3f}, {0.2f, 0.05f, 0.2f})});
  EXPECT_GT(refined(scene).primitives[0].triangleCount(), 50u);
}

TEST(Refine, NeverMoreVerticesThanAllowed) {
  const auto scene = boxOverFloor();
  for (const std::size_t most : {0, 28, 30, 100, 333}) {
    const RefineSettings settings{.error = 0.01f, .mostVertices = most};
    RefineReport report;
    const auto result = refineScene(scene, settings, 0, report);
    EXPECT_LE(result.vertexCount(), std::max(most, scene.vertexCount()));
    EXPECT_GE(result.vertexCount(), std::max(most * 9 / 10, scene.vertexCount())) << "it is used up";
    EXPECT_EQ(result.vertexCount() - scene.vertexCount(), report.verticesAdded);
    EXPECT_EQ(result.triangleCount() - scene.triangleCount(), report.trianglesAdded);
    EXPECT_GT(report.edgesOverBudget, 0u);
    EXPECT_GT(report.worstError, 0.01);
    EXPECT_EQ(tJunctions(result), 0);
  }
  const auto unlimited = reportOf(scene);
  EXPECT_EQ(unlimited.edgesOverBudget, 0u);
}

TEST(Refine, NoEdgeIsSplitBelowTheLeastLength) {
  const RefineSettings settings{.error = 0.01f, .leastEdge = 0.05f};
  RefineReport report;
  const auto result = refineScene(boxOverFloor(), settings, 0, report);
  EXPECT_GT(report.edgesTooShort, 0u);
  const EdgeTable table(result);
  // Halves of edges of the least length; those across a triangle are no shorter than its altitudes.
  EXPECT_GE(*std::min_element(table.length.begin(), table.length.end()), 0.25 * 0.05 * static_cast<double>(boundsOf(result).diagonal()));
}

TEST(Refine, TheSameForAnyNumberOfThreads) {
  const auto one = refined(boxOverFloor(), kSettings, 1), three = refined(boxOverFloor(), kSettings, 3);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_TRUE(one.primitives[p].positions == three.primitives[p].positions);
    EXPECT_TRUE(one.primitives[p].indices == three.primitives[p].indices);
  }
}

TEST(Refine, AtAnyScale) {
  const auto added = static_cast<double>(reportOf(boxOverFloor()).verticesAdded);
  for (const float scale : {1e-3f, 1e4f}) {
    const auto result = refined(scaled(boxOverFloor(), scale));
    // A ray through an edge of the box may fall to the other side.
    EXPECT_LE(std::abs(static_cast<double>(result.vertexCount() - boxOverFloor().vertexCount()) / added - 1.0), 0.05) << scale;
    EXPECT_LE(std::abs(borderOf(result) / (16.0 * static_cast<double>(scale)) - 1.0), 1e-5) << scale;
  }
}

TEST(Refine, BothSidesOfDoubleSidedMaterials) {
  auto below = boxOverFloor();
  for (auto& p : below.primitives[1].positions) p.y -= 0.75f;
  EXPECT_EQ(refined(below).primitives[0].triangleCount(), 2u) << "nobody looks at that side";
  below.materials[0].doubleSided = true;
  EXPECT_GT(refined(below).primitives[0].triangleCount(), 50u);
}

TEST(Refine, RefusesWhatItCannotDo) {
  const auto expectUsage = [](RefineSettings settings) {
    try {
      refined(boxOverFloor(), settings);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage) << error.what();
    }
  };
  expectUsage({.error = 0.0f});
  expectUsage({.error = -0.1f});
  expectUsage({.error = 1.1f});
  expectUsage({.error = std::numeric_limits<float>::quiet_NaN()});
  expectUsage({.error = kE, .leastEdge = 0.0f});
  expectUsage({.error = kE, .spacing = 0.0f});
  expectUsage({.error = kE, .resolution = 30});
}

TEST(Refine, PartOfABake) {
  BakeSettings settings{.resolution = 16, .terms = 8, .directionCount = 8};
  BakeReport report;
  const auto plain = bake(boxOverFloor(), settings, report);
  EXPECT_EQ(report.refinement.verticesAdded, 0u);
  settings.refine.error = 0.1f;
  double last = 0.0;
  const auto fine = bake(boxOverFloor(), settings, report, [&](const std::string& stage, double done) {
    if (stage != "refinement") return;
    EXPECT_GE(done, last);
    last = done;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_GT(report.refinement.verticesAdded, 0u);
  EXPECT_EQ(report.vertices, plain.scene.vertexCount() + report.refinement.verticesAdded);
  EXPECT_EQ(fine.scene.vertexCount(), report.vertices);
  EXPECT_EQ(fine.scene.triangleCount(), report.triangles);
}

}  // namespace
}  // namespace chiaro
