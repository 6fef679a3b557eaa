// What prepareScene() repairs, on meshes small enough to count by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>

#include "assets/error.h"
#include "assets/scene/load_scene.h"
#include "precompute/bake.h"
#include "precompute/mesh/half_edge.h"
#include "precompute/mesh/weld.h"

namespace chiaro {
namespace {

constexpr float kSixtyDegrees = std::numbers::pi_v<float> / 3.0f;

Scene sceneOf(Primitive primitive) {
  Scene scene;
  scene.meshNames = {"mesh"};
  scene.primitives = {std::move(primitive)};
  return scene;
}

/// Unit cube, eight shared corners, outward winding, times `scale`.
Primitive cube(float scale = 1.0f) {
  Primitive primitive;
  for (int i = 0; i < 8; ++i) primitive.positions.push_back(scale * glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1));
  primitive.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return primitive;
}

/// The same triangles, each with three corners of its own, as STL has them.
Primitive unwelded(const Primitive& primitive) {
  Primitive result;
  for (const auto i : primitive.indices) {
    result.indices.push_back(static_cast<std::uint32_t>(result.positions.size()));
    result.positions.push_back(primitive.positions[i]);
  }
  return result;
}

/// Geodesic-like sphere: rings by segments with poles.
Primitive sphere(int rings, int segments, float scale) {
  Primitive primitive;
  const auto at = [&](int ring, int segment) {
    const double theta = std::numbers::pi * ring / rings, phi = 2.0 * std::numbers::pi * segment / segments;
    return scale * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
  };
  const auto ringStart = [&](int ring) { return ring == 0 ? 0 : 1 + (ring - 1) * segments; };
  primitive.positions.push_back({0, scale, 0});
  for (int ring = 1; ring < rings; ++ring)
    for (int s = 0; s < segments; ++s) primitive.positions.push_back(at(ring, s));
  primitive.positions.push_back({0, -scale, 0});
  const int last = static_cast<int>(primitive.positions.size()) - 1;
  const auto add = [&](int a, int b, int c) {
    for (const int i : {a, b, c}) primitive.indices.push_back(static_cast<std::uint32_t>(i));
  };
  for (int s = 0; s < segments; ++s) {
    const int next = (s + 1) % segments;
    add(0, ringStart(1) + s, ringStart(1) + next);
    for (int ring = 1; ring + 1 < rings; ++ring) {
      add(ringStart(ring) + s, ringStart(ring + 1) + s, ringStart(ring + 1) + next);
      add(ringStart(ring) + s, ringStart(ring + 1) + next, ringStart(ring) + next);
    }
    add(ringStart(rings - 1) + s, last, ringStart(rings - 1) + next);
  }
  return primitive;
}

void expectNothingElse(const RepairReport& report, const RepairReport& expected) {
  EXPECT_EQ(report.weldedVertices, expected.weldedVertices);
  EXPECT_EQ(report.isolatedVertices, expected.isolatedVertices);
  EXPECT_EQ(report.degenerateTriangles, expected.degenerateTriangles);
  EXPECT_EQ(report.duplicateTriangles, expected.duplicateTriangles);
  EXPECT_EQ(report.nonManifoldEdges, expected.nonManifoldEdges);
  EXPECT_EQ(report.boundaryEdges, expected.boundaryEdges);
  EXPECT_EQ(report.normalsComputed, expected.normalsComputed);
  EXPECT_EQ(report.normalsRepaired, expected.normalsRepaired);
  EXPECT_EQ(report.tangentsComputed, expected.tangentsComputed);
}

void expectUnitAndInRange(const Scene& scene) {
  for (const auto& primitive : scene.primitives) {
    ASSERT_EQ(primitive.normals.size(), primitive.positions.size());
    for (const auto i : primitive.indices) ASSERT_LT(i, primitive.positions.size());
    for (const auto& n : primitive.normals) EXPECT_LE(std::abs(glm::length(n) - 1.0f), 1e-6f);
    for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
      const glm::vec3 t(primitive.tangents[i]);
      EXPECT_LE(std::abs(glm::length(t) - 1.0f), 1e-6f);
      EXPECT_LE(std::abs(glm::dot(t, primitive.normals[i])), 1e-6f);
      EXPECT_EQ(std::abs(primitive.tangents[i].w), 1.0f);
    }
  }
}

TEST(PrepareScene, ACubeKeepsItsEdges) {
  RepairReport report;
  const auto scene = prepareScene(sceneOf(cube()), kSixtyDegrees, report);
  EXPECT_EQ(scene.vertexCount(), 24u);
  EXPECT_EQ(scene.triangleCount(), 12u);
  expectNothingElse(report, {.normalsComputed = 24});
  for (const auto& n : scene.primitives[0].normals) EXPECT_EQ(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1.0f);
  expectUnitAndInRange(scene);
}

TEST(PrepareScene, ABluntCreaseAngleSmoothsTheCubeAndWeldsTriangleSoup) {
  RepairReport report;
  const auto scene = prepareScene(sceneOf(unwelded(cube())), 2.0f, report);
  EXPECT_EQ(scene.vertexCount(), 8u);
  expectNothingElse(report, {.weldedVertices = 28, .normalsComputed = 8});
  for (std::size_t i = 0; i < 8; ++i) {
    const auto expected = glm::normalize(scene.primitives[0].positions[i] - 0.5f);
    EXPECT_LE(glm::length(scene.primitives[0].normals[i] - expected), 1e-6f) << "angle weights do not see how a face is cut";
  }
}

TEST(PrepareScene, NormalsOfASphereAreRadialAtEveryScale) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    RepairReport report;
    const auto scene = prepareScene(sceneOf(sphere(32, 64, scale)), kSixtyDegrees, report);
    expectNothingElse(report, {.normalsComputed = 2 + 31 * 64});
    for (std::size_t i = 0; i < scene.vertexCount(); ++i)
      // Half an edge is .05 rad; symmetric neighbours cancel all but a fraction of it.
      EXPECT_LE(glm::length(scene.primitives[0].normals[i] - glm::normalize(scene.primitives[0].positions[i])), 0.01f);
  }
}

TEST(PrepareScene, CountsTrianglesWithoutAreaAndVerticesWithoutTriangles) {
  auto primitive = cube();
  primitive.positions.insert(primitive.positions.end(), {{5, 5, 5}, {0.5f, 0, 0}, {0, 0, 0}});
  primitive.indices.insert(primitive.indices.end(), {0, 0, 1});    // a corner twice
  primitive.indices.insert(primitive.indices.end(), {0, 9, 1});    // three points on a line
  primitive.indices.insert(primitive.indices.end(), {0, 10, 3});   // two corners in one place
  RepairReport report;
  const auto scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  EXPECT_EQ(scene.triangleCount(), 12u);
  // Vertex 8 was never used, vertex 9 only by a dropped triangle; vertex 10 is vertex 0 again.
  expectNothingElse(report, {.weldedVertices = 1, .isolatedVertices = 2, .degenerateTriangles = 3, .normalsComputed = 24});
  expectUnitAndInRange(scene);
}

TEST(PrepareScene, DropsATriangleSaidTwiceButNotItsBackSide) {
  auto primitive = cube();
  primitive.indices.insert(primitive.indices.end(), {3, 0, 2});  // the first, rotated
  RepairReport report;
  auto scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  EXPECT_EQ(scene.triangleCount(), 12u);
  expectNothingElse(report, {.duplicateTriangles = 1, .normalsComputed = 24});

  primitive = {};
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.indices = {0, 1, 2, 0, 2, 1};
  scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  EXPECT_EQ(scene.triangleCount(), 2u);
  EXPECT_EQ(scene.vertexCount(), 6u) << "front and back have opposite normals";
  expectNothingElse(report, {.normalsComputed = 6});
}

TEST(PrepareScene, ABowTieIsTwoSheetsThatTouch) {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}};
  primitive.indices = {0, 2, 1, 0, 3, 4};
  RepairReport report;
  const auto scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  EXPECT_EQ(scene.triangleCount(), 2u);
  // One vertex of the file, two smoothing groups.
  EXPECT_EQ(scene.vertexCount(), 6u);
  expectNothingElse(report, {.boundaryEdges = 6, .normalsComputed = 6});
}

TEST(PrepareScene, ThreeSheetsOnAnEdgeAreNotManifold) {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0.1f}, {0, 0, 1}};
  primitive.indices = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  RepairReport report;
  const auto scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  EXPECT_EQ(scene.triangleCount(), 3u);
  EXPECT_EQ(report.nonManifoldEdges, 1u);
  EXPECT_EQ(report.boundaryEdges, 6u);
  expectUnitAndInRange(scene);
}

TEST(PrepareScene, AFlippedTriangleIsNotSmoothedWithItsNeighbours) {
  auto primitive = cube();
  std::swap(primitive.indices[1], primitive.indices[2]);
  RepairReport report;
  const auto scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  EXPECT_EQ(scene.triangleCount(), 12u);
  EXPECT_EQ(report.nonManifoldEdges, 3u) << "its three edges run the same way as its neighbours'";
  EXPECT_EQ(report.boundaryEdges, 0u);
  EXPECT_EQ(scene.vertexCount(), 26u) << "its corners and those of the other half of its side are their own";
  expectUnitAndInRange(scene);
}

TEST(PrepareScene, EveryHalfEdgeMeshTakesEveryTriangle) {
  // Random triangles over few vertices: each way of being non-manifold occurs.
  std::uint32_t state = 1;
  const auto random = [&](std::uint32_t n) { return (state = state * 1664525u + 1013904223u) >> 8 & 0xffffu ? (state >> 8) % n : 0u; };
  for (int round = 0; round < 200; ++round) {
    Primitive primitive;
    for (std::uint32_t i = 0; i < 6; ++i)
      primitive.positions.push_back(glm::vec3(random(1000), random(1000), random(1000)) * 1e-3f);
    for (int t = 0; t < 12; ++t) {
      const std::uint32_t a = random(6), b = (a + 1 + random(5)) % 6;
      std::uint32_t c = random(6);
      while (c == a || c == b) c = (c + 1) % 6;
      for (const auto i : {a, b, c}) primitive.indices.push_back(i);
    }
    const auto edges = buildHalfEdges(primitive.positions, primitive.indices, weldPositions(primitive.positions));
    ASSERT_EQ(edges.mesh.n_faces(), 12u);
    for (std::size_t f = 0; f < 12; ++f) {
      for (int c = 0; c < 3; ++c) {
        const auto h = edges.halfedge(f, c);
        ASSERT_TRUE(h.is_valid());
        ASSERT_EQ(edges.mesh.face_handle(h).idx(), static_cast<int>(f));
        ASSERT_EQ(edges.cornerOf(h), c);
        const auto p = edges.mesh.point(edges.mesh.from_vertex_handle(h));
        const auto q = primitive.positions[primitive.indices[3 * f + static_cast<std::size_t>(c)]];
        ASSERT_EQ(glm::vec3(p[0], p[1], p[2]), q);
      }
    }
    RepairReport report;
    expectUnitAndInRange(prepareScene(sceneOf(primitive), kSixtyDegrees, report));
  }
}

TEST(PrepareScene, RepairsNormalsOfTheFile) {
  auto primitive = sphere(8, 16, 1.0f);
  for (const auto& p : primitive.positions) primitive.normals.push_back(p);
  primitive.normals[0] = {0, 0, 0};
  primitive.normals[5] *= 3.0f;
  primitive.normals[6] *= 1.0f + 1e-5f;  // what rounding to a file's decimals leaves
  RepairReport report;
  const auto scene = prepareScene(sceneOf(primitive), kSixtyDegrees, report);
  expectNothingElse(report, {.normalsRepaired = 2});
  expectUnitAndInRange(scene);
  EXPECT_LE(glm::length(scene.primitives[0].normals[0] - glm::vec3(0, 1, 0)), 1e-5f);
}

// Near the origin a scene without an area is just that, and left to the caller; far away it is said why.
TEST(PrepareScene, SaysWhenTheOriginIsTooFar) {
  RepairReport report;
  const auto at = [](glm::vec3 shift) {
    auto primitive = sphere(8, 16, 1.0f);
    for (auto& p : primitive.positions) p += shift;
    return sceneOf(primitive);
  };
  EXPECT_EQ(prepareScene(at({1e4f, 0, 0}), kSixtyDegrees, report).triangleCount(), at({}).triangleCount());
  try {
    prepareScene(at({0, -1e8f, 1e8f}), kSixtyDegrees, report);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("too far from the origin"), std::string::npos) << error.what();
  }
  Primitive line;
  line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.indices = {0, 1, 2};
  EXPECT_EQ(prepareScene(sceneOf(line), kSixtyDegrees, report).triangleCount(), 0u);
}

/// A quad in the plane z = 0 facing +z, the texture upright: u to the right, v downwards.
Primitive texturedQuad() {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  primitive.normals.assign(4, {0, 0, 1});
  primitive.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = 0;
  return primitive;
}

Material normalMapped() {
  Material material;
  material.normalTexture = 0;
  return material;
}

TEST(Tangents, FollowTheTextureAndItsUpwardDirection) {
  auto scene = sceneOf(texturedQuad());
  scene.materials = {normalMapped()};
  RepairReport report;
  auto prepared = prepareScene(scene, kSixtyDegrees, report);
  expectNothingElse(report, {.boundaryEdges = 4, .tangentsComputed = 4});
  for (const auto& t : prepared.primitives[0].tangents) EXPECT_LE(glm::length(t - glm::vec4(1, 0, 0, 1)), 1e-6f) << "green up is +y";

  for (auto& uv : scene.primitives[0].texcoords) uv.x = 1.0f - uv.x;  // mirrored
  prepared = prepareScene(scene, kSixtyDegrees, report);
  for (const auto& t : prepared.primitives[0].tangents) EXPECT_LE(glm::length(t - glm::vec4(-1, 0, 0, -1)), 1e-6f);
}

// A map that KHR_texture_transform turns or mirrors on the surface turns its frame along.
TEST(Tangents, FollowTheTransformOfTheNormalMap) {
  const auto tangentUnder = [](const TextureTransform& transform) {
    Scene scene = sceneOf(texturedQuad());
    scene.materials = {normalMapped()};
    scene.materials[0].normalTransform = transform;
    RepairReport report;
    return prepareScene(scene, kSixtyDegrees, report).primitives[0].tangents[0];
  };
  // A quarter turn of the coordinates from +U to -V, up the image: the image turns the other way, its right pointing down.
  EXPECT_LE(glm::length(tangentUnder({{5, 5}, 1.57079633f, {2, 2}}) - glm::vec4(0, -1, 0, 1)), 1e-6f);
  EXPECT_LE(glm::length(tangentUnder({{0, 0}, 0, {-1, 1}}) - glm::vec4(-1, 0, 0, -1)), 1e-6f);
}

TEST(Tangents, SplitVerticesWhereMirroredHalvesMeet) {
  auto primitive = texturedQuad();
  primitive.positions.insert(primitive.positions.end(), {{2, 0, 0}, {2, 1, 0}});
  primitive.normals.assign(6, {0, 0, 1});
  primitive.texcoords.insert(primitive.texcoords.end(), {{0, 1}, {0, 0}});  // u runs back
  primitive.indices.insert(primitive.indices.end(), {1, 4, 5, 1, 5, 2});
  auto scene = sceneOf(primitive);
  scene.materials = {normalMapped()};
  RepairReport report;
  const auto prepared = prepareScene(scene, kSixtyDegrees, report);
  EXPECT_EQ(prepared.vertexCount(), 8u);
  EXPECT_EQ(report.tangentsComputed, 8u);
  expectUnitAndInRange(prepared);
  const auto& p = prepared.primitives[0];
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(p.tangents[p.indices[3 * t + c]], (t < 2 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1)));
}

TEST(Tangents, OnlyWhereAMaterialReadsThem) {
  auto scene = sceneOf(texturedQuad());
  scene.primitives[0].tangents.assign(4, {1, 0, 0, 1});
  scene.materials.resize(1);
  RepairReport report;
  EXPECT_TRUE(prepareScene(scene, kSixtyDegrees, report).primitives[0].tangents.empty());

  scene.materials[0].normalTexture = 0;
  scene.primitives[0].tangents.assign(4, {2, 0, 1, -1});  // the file's own, not quite unit, not quite perpendicular
  const auto kept = prepareScene(scene, kSixtyDegrees, report);
  for (const auto& t : kept.primitives[0].tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, -1));
  EXPECT_EQ(report.tangentsComputed, 0u);

  auto brushed = sceneOf(sphere(8, 16, 1.0f));
  brushed.primitives[0].material = 0;
  brushed.materials.resize(1);
  brushed.materials[0].anisotropyStrength = 0.5f;
  const auto prepared = prepareScene(brushed, kSixtyDegrees, report);
  EXPECT_EQ(report.tangentsComputed, prepared.vertexCount()) << "anisotropy without texture coordinates";
  expectUnitAndInRange(prepared);
}

TEST(Tangents, SurviveACollapsedTexture) {
  auto scene = sceneOf(texturedQuad());
  scene.materials = {normalMapped()};
  scene.primitives[0].texcoords.assign(4, {0.5f, 0.5f});
  RepairReport report;
  expectUnitAndInRange(prepareScene(scene, kSixtyDegrees, report));
}

TEST(PrepareScene, APrimitiveOfRubbishDisappears) {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  primitive.indices = {0, 1, 2};
  RepairReport report;
  EXPECT_EQ(prepareScene(sceneOf(primitive), kSixtyDegrees, report).primitives.size(), 0u);
  EXPECT_EQ(report.degenerateTriangles, 1u);
}

TEST(PrepareScene, CountsAScanAsItsMakersDid) {
  const char* data = std::getenv("CHIARO_DATA");
  const char* source = std::getenv("CHIARO_SOURCE_DIR");
  const auto folder = data != nullptr ? std::filesystem::path(data) : std::filesystem::path(source != nullptr ? source : ".") / "../shared/data";
  const auto path = folder / "clear/meshes/snowden_109259.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there: set CHIARO_DATA to the evaluation pack";
  RepairReport report;
  const auto scene = prepareScene(loadScene(path), kSixtyDegrees, report);
  EXPECT_EQ(report.boundaryEdges, 43u);
  EXPECT_EQ(report.nonManifoldEdges, 88u);
  EXPECT_EQ(scene.triangleCount(), 109259u);
  expectUnitAndInRange(scene);
}

// A closed mesh wound inwards, with no normals to say which side is meant, is turned; with outward winding, flat or with normals it is not.
TEST(PrepareScene, TurnsAMeshThatIsInsideOut) {
  const auto flipped = [](Primitive primitive) {
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
    return primitive;
  };
  RepairReport report;
  const Scene turned = prepareScene(sceneOf(flipped(sphere(8, 12, 1.0f))), kSixtyDegrees, report);
  EXPECT_EQ(report.trianglesTurned, turned.triangleCount());
  const Primitive& ball = turned.primitives.front();
  for (std::size_t v = 0; v < ball.positions.size(); ++v) EXPECT_GE(glm::dot(ball.positions[v], ball.normals[v]), 0.9f);

  prepareScene(sceneOf(sphere(8, 12, 1.0f)), kSixtyDegrees, report);
  EXPECT_EQ(report.trianglesTurned, 0u);
  Primitive inwards = flipped(sphere(8, 12, 1.0f));
  for (const auto& position : inwards.positions) inwards.normals.push_back(-glm::normalize(position));
  prepareScene(sceneOf(inwards), kSixtyDegrees, report);
  EXPECT_EQ(report.trianglesTurned, 0u);
}

}  // namespace
}  // namespace chiaro
