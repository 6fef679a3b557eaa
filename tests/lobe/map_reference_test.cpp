/// Octahedral and equirectangular maps and spherical harmonics, double C++.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using namespace lobe64;

std::vector<Vec3> directions(int count) {
  std::mt19937_64 engine(11);
  std::normal_distribution<double> gauss;
  std::vector<Vec3> list{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  while (static_cast<int>(list.size()) < count) list.push_back(glm::normalize(Vec3(gauss(engine), gauss(engine), gauss(engine))));
  return list;
}

TEST(Octahedral, RoundTripAndLandmarks) {
  for (const Vec3& d : directions(20000)) EXPECT_NEAR(glm::distance(octahedralDecode(octahedralEncode(d)), d), 0.0, 1e-14);
  EXPECT_EQ(octahedralEncode(Vec3(0, 0, 1)), Vec2(.5, .5));
  EXPECT_EQ(octahedralEncode(Vec3(1, 0, 0)), Vec2(1, .5));
  EXPECT_EQ(octahedralEncode(Vec3(0, -2, 0)), Vec2(.5, 0));
  for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) EXPECT_NEAR(octahedralDecode(corner).z, -1.0, 1e-15);
  EXPECT_TRUE(std::isnan(octahedralEncode(Vec3(0, 0, 0)).x));
}

// Crossing an edge of the map is continuous: the texel wrapped to lies one step away on the sphere, for edges and corners.
TEST(Octahedral, WrappedNeighboursAreNeighbours) {
  for (int n : {2, 8, 64}) {
    // One texel is 2 / n on the octahedron, stretched by at most sqrt(3) sideways and sqrt(3) again where a face is nearest the centre.
    const double step = 6.0 / n;
    for (int i = 0; i < n; ++i) {
      for (const auto& [inside, outside] : {std::pair{IVec2(0, i), IVec2(-1, i)}, {IVec2(n - 1, i), IVec2(n, i)}, {IVec2(i, 0), IVec2(i, -1)}, {IVec2(i, n - 1), IVec2(i, n)}}) {
        const IVec2 wrapped = octahedralWrapTexel(outside, n);
        ASSERT_TRUE(wrapped.x >= 0 && wrapped.x < n && wrapped.y >= 0 && wrapped.y < n);
        EXPECT_LE(glm::distance(octahedralTexelDirection(inside, n), octahedralTexelDirection(wrapped, n)), step);
      }
    }
    EXPECT_EQ(octahedralWrapTexel(IVec2(-1, -1), n), IVec2(n - 1, n - 1));  // all four corners are -z
    EXPECT_EQ(octahedralWrapTexel(IVec2(n, -1), n), IVec2(0, n - 1));
    EXPECT_EQ(octahedralWrapTexel(IVec2(1, n - 1), n), IVec2(1, n - 1));
  }
}

// Exact solid angles: they fill the sphere, and each equals the integral of the map's Jacobian over its texel,
// dw = dA / |P|^3 with P on the octahedron (dA of p in [-1, 1]^2).
TEST(Octahedral, SolidAngles) {
  for (int n : {2, 4, 16, 64, 256}) {
    double total = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) total += octahedralTexelSolidAngle(IVec2(i, j), n);
    }
    EXPECT_NEAR(total / (4 * quadrature::kPi), 1.0, 1e-9) << n;
  }
  const int n = 8;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      // Split along the fold |px| + |py| = 1, where the integrand has a crease: fine midpoint sums, error 1e-5.
      double sum = 0;
      const int m = 200;
      for (int b = 0; b < m; ++b) {
        for (int a = 0; a < m; ++a) {
          const double x = std::abs(2 * (i + (a + .5) / m) / n - 1), y = std::abs(2 * (j + (b + .5) / m) / n - 1);
          const double z = 1 - x - y;
          const Vec3 p = z >= 0 ? Vec3(x, y, z) : Vec3(1 - y, 1 - x, z);
          sum += std::pow(glm::dot(p, p), -1.5);
        }
      }
      sum *= 4.0 / (n * n) / (m * m);
      EXPECT_NEAR(octahedralTexelSolidAngle(IVec2(i, j), n) / sum, 1.0, 2e-5) << i << ' ' << j;
    }
  }
}

TEST(Equirect, RoundTripAndLandmarks) {
  for (const Vec3& d : directions(20000)) EXPECT_NEAR(glm::distance(directionFromEquirect(equirectFromDirection(d)), d), 0.0, 1e-9);
  const auto uv = [](double x, double y, double z) { return equirectFromDirection(Vec3(x, y, z)); };
  EXPECT_EQ(uv(0, 0, -1), Vec2(.5, .5));     // the image's centre looks along -Z
  EXPECT_NEAR(uv(1, 0, 0).x, .75, 1e-12);    // +X on the right
  EXPECT_NEAR(uv(-1, 0, 0).x, .25, 1e-12);
  EXPECT_EQ(uv(0, 0, 1).x, 1.0);             // the seam
  EXPECT_EQ(uv(0, 1, 0), Vec2(.5, 0));       // the top row is +Y
  EXPECT_EQ(uv(0, -1, 0), Vec2(.5, 1));
  EXPECT_TRUE(std::isnan(uv(0, 0, 0).y));
  for (const Vec3& d : directions(2000)) {
    if (d.x == 0 && d.z == 0) continue;  // the poles have their own u
    EXPECT_NEAR(equirectFromDirection(d).x, .5 + std::atan2(d.x, -d.z) / (2 * quadrature::kPi), 1e-9);
    EXPECT_NEAR(equirectFromDirection(d).y, std::acos(d.y) / quadrature::kPi, 1e-7);
  }
}

TEST(Sh, GramMatrixIsTheIdentity) {
  double gram[25][25] = {};
  const quadrature::Rule rule = quadrature::gaussLegendre(8);  // exact to degree 15; the products have degree 8
  const int azimuths = 16;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    for (int k = 0; k < azimuths; ++k) {
      const double z = rule.node[i], s = std::sqrt(1 - z * z), phi = 2 * quadrature::kPi * k / azimuths;
      double y[25];
      shEvaluate(Vec3(s * std::cos(phi), s * std::sin(phi), z), y);
      for (int a = 0; a < 25; ++a) {
        for (int b = 0; b < 25; ++b) gram[a][b] += rule.weight[i] * 2 * quadrature::kPi / azimuths * y[a] * y[b];
      }
    }
  }
  for (int a = 0; a < 25; ++a) {
    for (int b = 0; b < 25; ++b) EXPECT_NEAR(gram[a][b], a == b ? 1.0 : 0.0, 1e-13) << a << ' ' << b;
  }
}

// The addition theorem, sum over m of Y_lm(a) Y_lm(b) = (2l+1)/(4 pi) P_l(a.b): a second, rotation-free check of every band.
TEST(Sh, AdditionTheorem) {
  const std::vector<Vec3> list = directions(60);
  for (const Vec3& a : list) {
    for (const Vec3& b : list) {
      double ya[25], yb[25];
      shEvaluate(a, ya);
      shEvaluate(b, yb);
      for (int l = 0; l <= 4; ++l) {
        double sum = 0;
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum += ya[i] * yb[i];
        const double t = std::clamp(glm::dot(a, b), -1.0, 1.0);
        EXPECT_NEAR(sum, (2 * l + 1) / (4 * quadrature::kPi) * std::legendre(static_cast<unsigned>(l), t), 1e-13);
      }
    }
  }
}

TEST(Sh, SignsAndZonalConstants) {
  double y[25];
  shEvaluate(glm::normalize(Vec3(.2, .5, .7)), y);
  EXPECT_GT(y[1], 0);  // l = 1 is (y, z, x) with plus signs
  EXPECT_GT(y[2], y[1]);
  EXPECT_LT(y[3], y[1]);
  for (unsigned l = 0; l <= 4; ++l) {
    const double exact = 2 * quadrature::kPi * quadrature::integrate([&](double t) { return t * std::legendre(l, t); }, 0, 1, 1);
    EXPECT_NEAR(shClampedCosine(static_cast<int>(l)), exact, 1e-13);
    EXPECT_NEAR(shConvolutionScale(static_cast<int>(l)), std::sqrt(4 * quadrature::kPi / (2 * l + 1)), 1e-14);
  }
  EXPECT_TRUE(std::isnan(shClampedCosine(5)));
  EXPECT_NEAR(shProjectionWeight(100) * 100, 4 * quadrature::kPi, 1e-13);
}

}  // namespace
}  // namespace chiaro
