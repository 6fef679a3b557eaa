/// The half-vector warp against the real thing: the lobe exp(l (dot(h, p) - 1)) evaluated at h = (wo + wi) / |wo + wi|.

#include <gtest/gtest.h>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using namespace lobe64;

struct WarpError {
  double squared, energy;
};

/// Squared relative error and energy ratio of `count` warped lobes of sharpness l at cos = c, by a grid over the patch of light directions
/// around the mirror direction where either counts.
WarpError measure(double c, double l, int count) {
  const Vec3 p(0, 0, 1);
  const double sine = std::sqrt(1 - c * c);
  const Vec3 wo(sine, 0, c);
  const Vec3 r = warpAxis(wo, p), across(0, 1, 0), along = glm::cross(across, r);
  const double reachAlong = 7 * 2 / std::sqrt(l), reachAcross = 7 * 2 / std::sqrt(l);
  const int n = 281;
  double error2 = 0, norm2 = 0, energy = 0, trueEnergy = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = reachAlong * (2.0 * i / (n - 1) - 1), y = reachAcross * (2.0 * j / (n - 1) - 1);
      const Vec3 wi = glm::normalize(r + x * along + y * across);
      const Vec3 d = glm::normalize(wo + wi) - p;
      const double truth = std::exp(-0.5 * l * glm::dot(d, d));
      double sum = 0;
      for (int k = 0; k < count; ++k) sum += sgEvaluate(sgWarpLobe(sphericalGaussian(p, l, 1), wo, count, k), wi);
      error2 += (sum - truth) * (sum - truth);
      norm2 += truth * truth;
      energy += sum;
      trueEnergy += truth;
    }
  }
  return {error2 / norm2, energy / trueEnergy};
}

// Closed form for one lobe, 2 (1 - sqrt c)^2 / (1 + c) at every sharpness; tables of ALGORITHMS 2.3 for three and five. Sharpness 1e5: the
// limit in which they hold.
TEST(Warp, ErrorsAreThePublishedOnes) {
  struct Row {
    double c, three, energyThree, five, energyFive;
  };
  for (const Row& row : {Row{.9, 7e-8, 1.000, 2e-9, 1.000}, Row{.7, 9e-5, .995, 2e-6, .999}, Row{.5, .0036, .979, 1.5e-4, .994},
                         Row{.3, .044, .943, .0066, .972}}) {
    const WarpError one = measure(row.c, 1e5, 1), three = measure(row.c, 1e5, 3), five = measure(row.c, 1e5, 5);
    std::printf("warp at cos %.1f: squared error %.2e, %.2e, %.2e with 1, 3, 5 lobes\n", row.c, one.squared, three.squared, five.squared);
    EXPECT_NEAR(one.squared / (2 * std::pow(1 - std::sqrt(row.c), 2) / (1 + row.c)), 1.0, 0.03);
    // Printed to one digit, and the curvature left at this sharpness adds about 1e-5.
    EXPECT_NEAR(three.squared, row.three, 0.08 * row.three + 2e-5);
    EXPECT_NEAR(five.squared, row.five, 0.15 * row.five + 2e-5);
    EXPECT_NEAR(one.energy, 1.0, 0.01);
    EXPECT_NEAR(three.energy, row.energyThree, 0.003);
    EXPECT_NEAR(five.energy, row.energyFive, 0.003);
    EXPECT_NEAR(sgWarpEnergy(row.c, 3), row.energyThree, 1e-12);
    EXPECT_NEAR(sgWarpEnergy(row.c, 5), row.energyFive, 1e-12);
  }
}

TEST(Warp, AtNormalIncidenceItIsExact) {
  for (int count : {1, 3, 5}) EXPECT_LE(measure(1.0, 1e5, count).squared, 2e-5) << count;
}

// dw_i = 4 |o.h| dw_h, so the isotropic warp keeps the integral of lobes narrow against the cosine.
TEST(Warp, IsotropicKeepsTheIntegral) {
  const Vec3 p(0, 0, 1), wo(std::sqrt(1 - .36), 0, .6);
  const SphericalGaussian g = sphericalGaussian(p, 1e4, 1);
  EXPECT_NEAR(sgIntegral(sgWarpIsotropic(g, wo)) / (4 * .6 * sgIntegral(g)), 1.0, 1e-9);
}

TEST(Warp, AxesStayUnitAndInThePlaneOfIncidence) {
  const Vec3 p(0, 0, 1);
  for (double angle : {0.0, 1e-8, 0.3, 1.0, 1.5, 2.5, 3.14159}) {
    const Vec3 wo(std::sin(angle), 0, std::cos(angle));
    for (double l : {0.0, 1e-3, 3.0, 100.0, 1e6}) {
      for (int k = 0; k < 5; ++k) {
        const SphericalGaussian g = sgWarpLobe(sphericalGaussian(p, l, 1), wo, 5, k);
        EXPECT_NEAR(glm::length(g.axis), 1.0, 1e-9);
        EXPECT_EQ(g.axis.y, 0.0);
        EXPECT_GE(g.sharpness, 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace chiaro
