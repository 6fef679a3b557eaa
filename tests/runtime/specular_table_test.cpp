#include "runtime/brdf/specular_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

// The split-sum albedo against values computed independently by NDF quadrature (ALGORITHMS 7.5, four digits).
TEST(SpecularTable, AlbedoMatchesPublishedQuadrature) {
  struct Case {
    double cosine, roughness, base, fresnel;
  };
  for (const Case c : {Case{.2, .3, .6893, .2254}, Case{.5, .5, .8349, .0223}, Case{.8, .3, .9869, .0008}, Case{1, .5, .9158, 0},
                       Case{1, 1, .3068, 0}, Case{.05, .5, .7703, .1643}}) {
    const auto albedo = ggxAlbedo(c.roughness * c.roughness, c.cosine);
    EXPECT_LE(std::abs(albedo.x - c.base), 2e-3) << c.cosine << " " << c.roughness;
    EXPECT_LE(std::abs(albedo.y - c.fresnel), 2e-3) << c.cosine << " " << c.roughness;
  }
}

// The promise that keeps a uniform environment uniform: weights are not negative and sum to the albedo.
TEST(SpecularTable, WeightsSumToTheAlbedo) {
  const SpecularTable table = makeSpecularTable(5, 9);
  for (int j = 0; j < table.cosineCount; ++j) {
    for (int i = 0; i < table.roughnessCount; ++i) {
      double base = 0, fresnel = 0;
      for (int k = 0; k < SpecularTable::kLobeCount; ++k) {
        const glm::vec4 entry = table.entries[static_cast<std::size_t>((k * table.cosineCount + j) * table.roughnessCount + i)];
        EXPECT_GE(entry.z, 0.0f);
        EXPECT_GE(entry.w, 0.0f);
        EXPECT_LE(std::abs(entry.x), 32.0f);
        base += entry.z;
        fresnel += entry.w;
      }
      const double roughness = lobe64::kTableMinRoughness + (lobe64::kTableMaxRoughness - lobe64::kTableMinRoughness) * i / 4.0;
      const double cosine = std::max(std::pow(j / 8.0, 2), 1e-3);
      const auto albedo = ggxAlbedo(roughness * roughness, cosine);
      EXPECT_LE(std::abs(base - albedo.x), 1e-4);
      EXPECT_LE(std::abs(fresnel - albedo.y), 1e-4);
    }
  }
}

// Squared error of the lobes against D V cos over the sphere, relative to its square: what the fit leaves. The bounds are twice what was measured.
TEST(SpecularTable, LobesFollowTheSlice) {
  const SpecularTable table = makeSpecularTable();
  const int i = 12;  // roughness .4
  const double alpha = .16;
  struct Case {
    int row;
    double bound;
  };
  for (const Case c : {Case{32, .001}, Case{24, .002}, Case{16, .02}}) {
    const double cosine = std::pow(c.row / 32.0, 2);
    const lobe64::Vec3 n(0, 0, 1), wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    const lobe64::Vec3 x = lobe64::incidenceTangent(n, wo);
    double error = 0, power = 0;
    constexpr int kSteps = 300;
    for (int a = 0; a < kSteps; ++a) {
      for (int b = 0; b < kSteps; ++b) {
        const double z = 1 - (a + .5) / kSteps, phi = (b + .5) / kSteps * lobe64::kTwoPi, s = std::sqrt(1 - z * z);
        const lobe64::Vec3 wi(s * std::cos(phi), s * std::sin(phi), z);
        const lobe64::Vec3 wh = glm::normalize(wi + wo);
        const double truth = lobe64::ggxDistribution(wh.z, alpha) * lobe64::ggxVisibility(cosine, z, alpha) * z;
        double fitted = 0;
        for (int k = 0; k < SpecularTable::kLobeCount; ++k) {
          const glm::dvec4 entry(table.entries[static_cast<std::size_t>((k * table.cosineCount + c.row) * table.roughnessCount + i)]);
          const auto lobe = lobe64::specularTableLobe(entry, n, x, cosine, alpha);
          fitted += (lobe.weight + lobe.fresnelWeight) * lobe64::sgEvaluate(lobe64::sphericalGaussian(lobe.axis, lobe.sharpness, 1.0), wi) /
                    lobe64::sgUnitIntegral(lobe.sharpness);
        }
        error += (fitted - truth) * (fitted - truth);
        power += truth * truth;
      }
    }
    EXPECT_LE(error / power, c.bound) << "cosine " << cosine;
    std::printf("cosine %.3f: squared error %.5f of the slice's\n", cosine, error / power);
  }
}

TEST(SpecularTable, SameForAnyThreadCount) {
  const SpecularTable one = makeSpecularTable(4, 5, 1), three = makeSpecularTable(4, 5, 3);
  EXPECT_EQ(one.entries, three.entries);
}

}  // namespace
}  // namespace chiaro
