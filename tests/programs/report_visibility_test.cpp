// Ways to store visibility, where geometry says what is seen.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "precompute/random_directions.h"
#include "precompute/report/visibility/ground.h"
#include "precompute/report/visibility/haar.h"
#include "precompute/report/visibility/haar_method.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/report/visibility/product_error.h"
#include "precompute/report/visibility/sh_method.h"
#include "precompute/report/visibility/spherical_harmonics.h"
#include "precompute/report/visibility/visibility_tables.h"
#include "shaders/cpp/lobe.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

constexpr int kBands = 10;

glm::dvec3 someDirection(std::mt19937& random) {
  const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * std::numbers::pi * uniform(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

double legendre(int l, double x) { return std::legendre(static_cast<unsigned>(l), x); }

TEST(SphericalHarmonics, AreThoseOfTheShaders) {
  std::mt19937 random(1);
  std::vector<double> ours(25);
  for (int i = 0; i < 100; ++i) {
    const auto w = i == 0 ? glm::dvec3(0, 0, 1) : i == 1 ? glm::dvec3(0, 0, -1) : someDirection(random);
    double theirs[25];
    lobe64::shEvaluate(w, theirs);
    evaluateSh(w, 5, ours.data());
    for (std::size_t k = 0; k < 25; ++k) ASSERT_LE(std::abs(ours[k] - theirs[k]), 1e-12) << k;
  }
}

TEST(SphericalHarmonics, AddUpToLegendrePolynomials) {  // the addition theorem, for every band
  std::mt19937 random(2);
  std::vector<double> a(kBands * kBands), b(a);
  for (int i = 0; i < 100; ++i) {
    const auto u = someDirection(random), v = someDirection(random);
    evaluateSh(u, kBands, a.data());
    evaluateSh(v, kBands, b.data());
    for (int l = 0; l < kBands; ++l) {
      double sum = 0.0;
      for (int k = l * l; k < (l + 1) * (l + 1); ++k) sum += a[static_cast<std::size_t>(k)] * b[static_cast<std::size_t>(k)];
      ASSERT_LE(std::abs(sum - (2 * l + 1) / (4.0 * std::numbers::pi) * legendre(l, glm::dot(u, v))), 1e-11) << l;
    }
  }
}

TEST(SphericalHarmonics, LobeBandsAreMeansOfLegendrePolynomials) {
  for (const double sharpness : {1e-3, 0.3, 3.0, 30.0, 300.0, 3000.0, 1e6}) {
    const auto rho = lobeBands(sharpness, kBands);
    const LobePattern pattern(sharpness, 200000);  // its strata are a midpoint rule in the cumulative distribution
    std::vector<glm::vec3> directions;
    pattern.directions({0, 0, 1}, 0.0, directions);
    for (int l = 0; l < kBands; ++l) {
      double mean = 0.0;
      for (const auto& w : directions) mean += legendre(l, std::min(static_cast<double>(w.z), 1.0));
      mean /= static_cast<double>(directions.size());
      EXPECT_LE(std::abs(rho[static_cast<std::size_t>(l)] - mean), 3e-5) << sharpness << " band " << l;
    }
    EXPECT_LE(std::abs(rho[1] - lobe64::vmfMeanCosine(sharpness)), 1e-12);
  }
  EXPECT_EQ(lobeBands(0.0, 3), (std::vector<double>{1.0, 0.0, 0.0}));
}

TEST(SphericalHarmonics, OfCapsAreTheirClosedForms) {
  // c_lm = 2 pi (P_{l-1}(x) - P_{l+1}(x)) / (2 l + 1) Y_lm(axis), x = cosine of the cap's angle; a half-space has x = 0.
  // Texels are in or out as a whole: some 350 on the edge, each wrong by .3 of its 8e-4 sr (rms) times a harmonic of about 1.
  constexpr double kTexelEdges = 5e-3;
  const OctahedralGrid grid(128);
  const auto axis = glm::normalize(glm::dvec3(0.3, -0.7, 0.5));
  std::vector<double> basis(kBands * kBands);
  evaluateSh(axis, kBands, basis.data());
  for (const double x : {0.0, 0.5, 0.9, -0.6}) {
    std::vector<float> inside(grid.texelCount);
    for (std::size_t t = 0; t < grid.texelCount; ++t) inside[t] = glm::dot(glm::dvec3(grid.direction(t)), axis) > x ? 1.0f : 0.0f;
    const auto projected = projectSh(grid, inside, kBands);
    for (int l = 0; l < kBands; ++l) {
      const double zonal = l == 0 ? 2.0 * std::numbers::pi * (1.0 - x)
                                  : 2.0 * std::numbers::pi * (legendre(l - 1, x) - legendre(l + 1, x)) / (2 * l + 1);
      for (int k = l * l; k < (l + 1) * (l + 1); ++k)
        EXPECT_LE(std::abs(projected[static_cast<std::size_t>(k)] - zonal * basis[static_cast<std::size_t>(k)]), kTexelEdges)
            << "cap " << x << " coefficient " << k;
    }
  }
}

TEST(Haar, IsOrthonormal) {
  constexpr int kSide = 8;
  constexpr std::size_t kCount = kSide * kSide;
  std::vector<std::vector<float>> rows;
  for (std::size_t i = 0; i < kCount; ++i) {
    std::vector<float> image(kCount, 0.0f);
    image[i] = 1.0f;
    haarInverse(image.data(), kSide);
    rows.push_back(image);
  }
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t j = 0; j < kCount; ++j) {
      double product = 0.0;
      for (std::size_t k = 0; k < kCount; ++k) product += static_cast<double>(rows[i][k] * rows[j][k]);
      ASSERT_LE(std::abs(product - (i == j ? 1.0 : 0.0)), 1e-6) << i << " " << j;
    }
}

TEST(Haar, ReconstructsPerfectly) {
  constexpr int kSide = 64;
  std::mt19937 random(3);
  std::vector<float> image(kSide * kSide);
  for (float& value : image) value = uniform(random) < 0.5 ? 0.0f : 1.0f;
  auto transformed = image;
  haarForward(transformed.data(), kSide);
  double mean = 0.0, before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    mean += static_cast<double>(image[i]) / (kSide * kSide);
    before += static_cast<double>(image[i] * image[i]);
    after += static_cast<double>(transformed[i] * transformed[i]);
  }
  EXPECT_LE(std::abs(static_cast<double>(transformed[0]) - mean * kSide), 1e-4);
  EXPECT_LE(std::abs(before - after), 1e-6 * before);
  haarInverse(transformed.data(), kSide);
  for (std::size_t i = 0; i < image.size(); ++i) ASSERT_LE(std::abs(image[i] - transformed[i]), 1e-5f);
}

TEST(Haar, CubeTexelsHoldTheirDirections) {
  const CubeGrid grid(64);
  for (std::size_t t = 0; t < grid.texelCount; ++t) ASSERT_EQ(grid.texelAt({grid.x[t], grid.y[t], grid.z[t]}), t);
}

TEST(LobePattern, HoldsTheLobe) {
  for (const double sharpness : kLobeSharpness) {
    const LobePattern pattern(sharpness, 4096);
    const auto axis = glm::normalize(glm::dvec3(0.2, 0.9, -0.4));
    std::vector<glm::vec3> directions;
    pattern.directions(axis, 1.0, directions);
    for (const double distance : {-0.5, -0.03, 0.0, 0.1, 0.7}) {  // of a half-space's border from the axis
      const auto across = glm::normalize(glm::cross(axis, glm::dvec3(1, 0, 0)));
      const auto normal = std::sin(distance) * axis + std::cos(distance) * across;
      double share = 0.0;
      for (const auto& w : directions) share += glm::dot(glm::dvec3(w), normal) > 0.0 ? 1.0 : 0.0;
      EXPECT_LE(std::abs(share / 4096.0 - lobe64::sgHalfSpaceFraction(std::sin(distance), sharpness)), 4e-3) << sharpness;
    }
  }
}

VisibilitySettings small() {
  VisibilitySettings settings;
  settings.vertices = 40;
  settings.points = 20;
  settings.basisVertices = 100;
  settings.rays = 2048;
  settings.terms = 16;
  return settings;
}

// The floor y = 0 under a ceiling over x > 0 that is as good as a half-plane.
constexpr float kHeight = 1.0f;
Scene underHalfPlane() {
  Primitive ceiling;
  addGrid(ceiling, {0, kHeight, 4e3f}, {4e3f, 0, 0}, {0, 0, -8e3f}, 1);
  return sceneWith({floorGrid(2.0f, 10), ceiling});
}

// What is seen of that scene: from the floor two half-spaces, from the ceiling's upper side one.
class ExactMethod : public VisibilityMethod {
 public:
  std::string name() const override { return "exact"; }
  StoredBytes bytes() const override { return {}; }
  LobeFraction at(const SurfacePoint& point) const override {
    return [&point](const Lobe& lobe) {
      const glm::dvec3 p(point.view.front);
      double seen = 0.0;
      for (const auto& w : lobe.directions) {
        const bool hidden = p.y < 0.5 && p.x * static_cast<double>(w.y) + (1.0 - p.y) * static_cast<double>(w.x) > 0.0;
        seen += w.y > 0.0f && !hidden ? 1.0 : 0.0;
      }
      return seen / static_cast<double>(lobe.directions.size());
    };
  }
};

TEST(VisibilityComparison, TruthIsTheHalfSpaceOnAnOpenPlane) {
  const auto scene = sceneWith({floorGrid(2.0f, 10)});
  const auto result = compareVisibility(scene, baselineMethods, small());
  ASSERT_EQ(result.methods.size(), 11u);
  EXPECT_EQ(result.pointsAtVertices, 40u);
  EXPECT_EQ(result.pointsInTriangles, 20u);
  for (std::size_t s = 0; s < kLobeSharpness.size(); ++s) {
    EXPECT_LE(result.truthNoise[s], 3e-3);
    for (const auto& method : result.methods) {
      EXPECT_TRUE(std::isfinite(method.atVertices[s]) && std::isfinite(method.inTriangles[s])) << method.name;
      if (method.name == "no shadows") {
        EXPECT_LE(method.atVertices[s], 2.5e-3) << "noise of the truth, error of the fit 3.4e-4";
      }
      // Half a texel of 64 a side is .03 rad, but the map is smooth across the horizon.
      if (method.name.starts_with("SSDF with horizon")) {
        EXPECT_LE(method.atVertices[s], 1e-2);
      }
      if (method.name == "SH 100" && kLobeSharpness[s] <= 10) {
        EXPECT_LE(method.inTriangles[s], 5e-3);
      }
      if (method.name == "Haar 96") {
        EXPECT_LE(method.inTriangles[s], 4e-2);
      }
    }
  }
}

TEST(VisibilityComparison, TruthIsExactUnderAHalfPlane) {
  const auto scene = underHalfPlane();
  const auto result = compareVisibility(
      scene,
      [](const VisibilityInput& input) {
        auto methods = baselineMethods(input);
        methods.push_back(std::make_unique<ExactMethod>());
        return methods;
      },
      small());
  const auto& exact = result.methods.back();
  for (std::size_t s = 0; s < kLobeSharpness.size(); ++s) {
    // Both are averages over thousands of directions; the ceiling's far end hides an angle of .0003.
    EXPECT_LE(exact.atVertices[s], 3e-3) << kLobeSharpness[s];
    for (const auto& method : result.methods) {
      EXPECT_TRUE(std::isfinite(method.atVertices[s])) << method.name;
      EXPECT_GE(method.atVertices[s], 0.0) << method.name;
      if (method.name == "SSDF uncompressed" && kLobeSharpness[s] >= 100) {
        EXPECT_LE(method.atVertices[s], 1.5e-2);
      }
      if (method.name == "no shadows") {
        EXPECT_GE(method.atVertices[s], 0.1);
      }
    }
  }
}

TEST(VisibilityComparison, SameFiguresForAnyThreadCount) {
  const auto scene = boxesOnFloor();
  auto settings = small();
  settings.vertices = settings.points = 5;
  settings.resolution = 32;
  settings.threads = 1;
  const auto one = compareVisibility(scene, baselineMethods, settings);
  settings.threads = 3;
  const auto three = compareVisibility(scene, baselineMethods, settings);
  for (std::size_t m = 0; m < one.methods.size(); ++m) {
    EXPECT_EQ(one.methods[m].atVertices, three.methods[m].atVertices) << one.methods[m].name;
    EXPECT_EQ(one.methods[m].inTriangles, three.methods[m].inTriangles) << one.methods[m].name;
  }
}

TEST(VisibilityComparison, UndefinedEstimatesAreNotHidden) {
  class Undefined : public VisibilityMethod {
   public:
    std::string name() const override { return "undefined"; }
    StoredBytes bytes() const override { return {}; }
    LobeFraction at(const SurfacePoint&) const override {
      return [](const Lobe&) { return std::numeric_limits<double>::quiet_NaN(); };
    }
  };
  auto settings = small();
  settings.vertices = 2;
  settings.points = 0;
  SceneComparison scene;
  scene.scene = "floor";
  scene.comparison = compareVisibility(
      sceneWith({floorGrid(1.0f, 2)}),
      [](const VisibilityInput&) {
        std::vector<std::unique_ptr<VisibilityMethod>> methods;
        methods.push_back(std::make_unique<Undefined>());
        return methods;
      },
      settings);
  EXPECT_TRUE(std::isnan(scene.comparison.methods[0].atVertices[0]));
  EXPECT_TRUE(std::isnan(scene.comparison.methods[0].inTriangles[0])) << "nothing was measured";
  const auto json = nlohmann::json::parse(visibilityJson({scene}, settings, "0"));
  EXPECT_TRUE(json["scenes"][0]["methods"][0]["mean_abs_at_vertices"][0].is_null());
}

class Methods : public testing::Test {
 protected:
  Methods() : scene_(boxesOnFloor()), rays_(scene_), viewpoints_(viewpointsOf(scene_, rays_)) {
    for (std::size_t v = 0; v < viewpoints_.size(); ++v) all_.push_back(v);
  }
  VisibilityInput input() const {
    return {.rays = rays_, .viewpoints = viewpoints_, .encoded = all_, .basis = all_, .resolution = 32, .terms = 12};
  }
  Scene scene_;
  RayScene rays_;
  std::vector<Viewpoint> viewpoints_;
  std::vector<std::size_t> all_;
};

TEST_F(Methods, CountTheirBytes) {
  const auto from = input();
  const auto methods = baselineMethods(from);
  const double shared = 4.0 * 1024 + 2.0 * 12 * 1024 + 4.0 * 12;  // float mean, half functions, float scales
  const std::vector<std::tuple<std::string, double, double>> expected{{"SH 25", 50, 4},
                                                                      {"SH 49", 98, 4},
                                                                      {"SH 100", 200, 4},
                                                                      {"Haar 24", 96, 4},
                                                                      {"Haar 48", 192, 4},
                                                                      {"Haar 96", 384, 4},
                                                                      {"visibility PCA 12", 24, shared},
                                                                      {"SSDF with horizon PCA 12", 24, shared},
                                                                      {"SSDF PCA 12", 24, shared},
                                                                      {"SSDF uncompressed", 2048, 0},
                                                                      {"no shadows", 0, 0}};
  ASSERT_EQ(methods.size(), expected.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto& [name, each, once] = expected[m];
    EXPECT_EQ(methods[m]->name(), name);
    EXPECT_EQ(methods[m]->bytes().eachVertex, each) << name;
    EXPECT_EQ(methods[m]->bytes().shared, once) << name;
    EXPECT_EQ(methods[m]->bytes().perVertex(10), each + once / 10) << name;
  }
}

TEST_F(Methods, InterpolateBetweenCorners) {
  // Methods that are linear up to the fraction: half way between two vertices is the mean of both.
  const auto from = input();
  auto methods = makeShMethods(from, {5});
  for (auto& method : makeHaarMethods(from, {48})) methods.push_back(std::move(method));
  Lobe lobe{.axis = glm::normalize(glm::dvec3(0.4, 0.8, 0.1)), .sharpness = 30.0};
  LobePattern(30.0, 512).directions(lobe.axis, 0.0, lobe.directions);
  SurfacePoint a{.vertices = {3, 3, 3}, .view = viewpoints_[3]}, b{.vertices = {9, 9, 9}, .view = viewpoints_[9]},
      between{.vertices = {3, 9, 4}, .weights = {0.5f, 0.5f, 0.0f}, .view = viewpoints_[3]};
  for (const auto& method : methods)
    EXPECT_LE(std::abs(method->at(between)(lobe) - 0.5 * (method->at(a)(lobe) + method->at(b)(lobe))), 1e-5) << method->name();
}

TEST_F(Methods, EnoughTermsAreTheMapItself) {
  auto from = input();
  from.terms = static_cast<int>(all_.size());
  const OctahedralGrid grid(from.resolution);
  const TracedVertices traced(from, grid);
  const auto compressed = makePcaMethod(from, traced, ssdfOfOccluders()),
             exact = makeUncompressedMethod(from, traced, ssdfOfOccluders());
  Lobe lobe{.axis = glm::normalize(glm::dvec3(0.4, 0.8, 0.1)), .sharpness = 100.0};
  for (const auto v : {0u, 7u, 20u}) {
    const SurfacePoint point{.vertices = {v, v, v}, .view = viewpoints_[v]};
    // 16-bit weights and half functions; 1e-3 rad is .004 at sharpness 100.
    EXPECT_LE(std::abs(compressed->at(point)(lobe) - exact->at(point)(lobe)), 5e-3) << v;
  }
}

/// Says the same of every lobe.
class ConstantShare : public VisibilityMethod {
 public:
  explicit ConstantShare(double share) : share_(share) {}
  std::string name() const override { return "constant"; }
  StoredBytes bytes() const override { return {}; }
  LobeFraction at(const SurfacePoint&) const override {
    return [this](const Lobe&) { return share_; };
  }

 private:
  double share_;
};

TEST(ProductErrors, OfAHorizonAlone) {
  const auto scene = sceneWith({floorGrid(2.0f, 30)});
  const RayScene rays(scene);
  const auto points = pointsAtVertices(viewpointsOf(scene, rays), 800, 1);
  const ConstantShare none(0.0), all(1.0);
  const auto horizon = makeUnoccludedMethod();
  const auto errors = productErrors(rays, points, {&none, &all, horizon.get()}, 128, 3, 0, {});
  ASSERT_EQ(errors.size(), 4u);
  const auto& sharpness = productSharpness();
  for (std::size_t s = 0; s < sharpness.size(); ++s) {
    SCOPED_TRACE(sharpness[s]);
    EXPECT_NEAR(errors[0].inner[s], 1.0, 1e-12) << "all of it is missing";
    EXPECT_NEAR(errors[0].vector[s], 1.0, 1e-12);
    // The horizon is a half-space: exact, but for 128 rays, which tell a share to .01.
    EXPECT_LE(errors[2].inner[s], 4e-4);
    EXPECT_NEAR(errors[2].vector[s], errors[3].vector[s], 1e-3);
    EXPECT_EQ(errors[3].inner[s], 0.0);
    // Nothing hidden: |G - G V|^2 over |G V|^2 is what of G^2, sharpness doubled, is below the horizon over what is above. Axes are uniform above it; of 12800 those about a lobe's width from it count: four standard errors.
    double above = 0.0;
    const int steps = 2000;
    for (int i = 0; i < steps; ++i) above += lobe64::sgHalfSpaceFraction((i + 0.5) / steps, 2.0 * sharpness[s]) / steps;
    EXPECT_NEAR(errors[1].vector[s], (1.0 - above) / above, 4.0 * std::sqrt(0.15 / std::sqrt(2.0 * sharpness[s]) / 12800.0) / above);
    EXPECT_LT(errors[3].vector[s], errors[1].vector[s]);
  }
}

TEST(SurfacePoints, InTrianglesAreUniformByArea) {
  // A floor of 4 x 4 and one of 2 x 2 far away: four points in five lie on the first.
  Primitive other;
  addGrid(other, {9, 0, 2}, {2, 0, 0}, {0, 0, -2}, 3);
  const auto scene = sceneWith({floorGrid(2.0f, 2), other});
  const RayScene rays(scene);
  const auto points = pointsInTriangles(scene, rays, 4000, 1);
  ASSERT_EQ(points.size(), 4000u);
  int first = 0;
  glm::dvec3 mean(0.0);
  for (const auto& point : points) {
    EXPECT_LE(std::abs(point.weights[0] + point.weights[1] + point.weights[2] - 1.0f), 1e-6f);
    EXPECT_GT(point.view.front.y, 0.0f);
    if (point.view.front.x > 5.0f) {
      for (const auto v : point.vertices) EXPECT_GE(v, 9u);
      continue;
    }
    ++first;
    mean += glm::dvec3(point.view.front);
  }
  EXPECT_LE(std::abs(first - 3200), 4 * 25) << "four standard errors";
  EXPECT_LE(glm::length(mean / static_cast<double>(first)), 0.1);
}

TEST(Ground, LiesUnderTheScene) {
  auto scene = scaled(boxesOnFloor(), 2.0f, {1, 5, 0});
  const auto before = boundsOf(scene);
  const auto vertices = scene.vertexCount();
  addGround(scene);
  EXPECT_EQ(scene.vertexCount(), vertices + 1600);
  const auto after = boundsOf(scene);
  EXPECT_NEAR(after.upper.x - after.lower.x, 3.0f * before.diagonal(), 1e-3f);
  EXPECT_LT(after.lower.y, before.lower.y);
  EXPECT_GE(after.lower.y, before.lower.y - 0.01f * before.diagonal());
  const auto& ground = scene.primitives.back();
  const auto corner = [&](std::size_t i) { return ground.positions[ground.indices[i]]; };
  EXPECT_GT(glm::cross(corner(1) - corner(0), corner(2) - corner(0)).y, 0.0f) << "faces up";
}

}  // namespace
}  // namespace chiaro
