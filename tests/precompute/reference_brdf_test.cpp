#include "precompute/reference/brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "precompute/reference/sampling.h"
#include "precompute/reference/shading_normal.h"
#include "shaders/cpp/lobe.h"

namespace chiaro::reference {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 direction(double cosine, double azimuth) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// Reflectance to wo under radiance 1 everywhere, F = 1, by plain quadrature over wi of what shaders/lobe says. alpha at least 0.05.
double furnace(double alphaX, double alphaY, glm::dvec3 wo) {
  constexpr int kRows = 500;
  double sum = 0.0;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < 2 * kRows; ++j) {
      const glm::dvec3 wi = direction((i + 0.5) / kRows, kPi * (j + 0.5) / kRows);
      const glm::dvec3 wh = glm::normalize(wo + wi);
      sum += lobe64::ggxDistributionAnisotropic(wh, alphaX, alphaY) * lobe64::ggxVisibilityAnisotropic(wo, wi, alphaX, alphaY) *
             wi.z;
    }
  }
  return sum * 2.0 * kPi / (2.0 * kRows * kRows);
}

TEST(ReferenceBrdf, AgreesWithTheLobesWrittenApartFromIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    Brdf brdf;
    brdf.diffuse = {uniform(random), uniform(random), uniform(random)};
    brdf.f0 = {uniform(random), uniform(random), uniform(random)};
    brdf.alphaX = std::pow(10.0, -4.0 * uniform(random));
    brdf.alphaY = std::pow(10.0, -4.0 * uniform(random));
    const glm::dvec3 wo = direction(1e-3 + 0.999 * uniform(random), 2.0 * kPi * uniform(random));
    const glm::dvec3 wi = direction(1e-3 + 0.999 * uniform(random), 2.0 * kPi * uniform(random));
    const glm::dvec3 wh = glm::normalize(wo + wi);
    const glm::dvec3 f = lobe64::fresnelSchlick(brdf.f0, glm::dot(wo, wh));
    const double specular = lobe64::ggxDistributionAnisotropic(wh, brdf.alphaX, brdf.alphaY) *
                            lobe64::ggxVisibilityAnisotropic(wo, wi, brdf.alphaX, brdf.alphaY);
    const glm::dvec3 expected = (f * specular + (1.0 - std::max({f.x, f.y, f.z})) * brdf.diffuse / kPi) * wi.z;
    const glm::dvec3 got = brdfTimesCosine(brdf, wo, wi);
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(got[c] - expected[c]) / expected[c];
      if (!(error <= worst)) worst = error;
    }
  }
  EXPECT_LE(worst, 1e-11);  // two orders of double arithmetic; D's square doubles what wh's rounding does at alpha 1e-4
}

TEST(ReferenceBrdf, IsReciprocalAndZeroBelowTheHorizon) {
  Brdf brdf{glm::dvec3(0.3, 0.5, 0.7), glm::dvec3(0.04, 0.5, 0.9), glm::dvec3(1.0), 0.6, 0.1};
  const glm::dvec3 a = direction(0.8, 0.3);
  const glm::dvec3 b = direction(0.15, 2.0);
  const glm::dvec3 difference = brdfTimesCosine(brdf, a, b) / b.z - brdfTimesCosine(brdf, b, a) / a.z;
  EXPECT_LE(glm::length(difference), 1e-14);
  EXPECT_EQ(brdfTimesCosine(brdf, a, {0.6, 0.0, -0.8}), glm::dvec3(0.0));
  EXPECT_EQ(brdfTimesCosine(brdf, {0.6, 0.0, -0.8}, a), glm::dvec3(0.0));
}

TEST(ReferenceBrdf, DensitiesIntegrateToOne) {
  for (const double alphaY : {0.2, 0.7}) {
    const Brdf brdf{glm::dvec3(0.0), glm::dvec3(1.0), glm::dvec3(1.0), 0.5, alphaY};
    for (const double cosine : {0.05, 0.6, 1.0}) {
      const glm::dvec3 wo = direction(cosine, 0.7);
      double reflection = 0.0;
      double lambert = 0.0;
      constexpr int kRows = 1000;
      for (int i = 0; i < kRows; ++i) {
        for (int j = 0; j < 2 * kRows; ++j) {
          const glm::dvec3 wi = direction(1.0 - 2.0 * (i + 0.5) / kRows, kPi * (j + 0.5) / kRows);
          reflection += reflectionDensity(brdf, wo, wi);
          lambert += cosineDensity(wi);
        }
      }
      const double cell = 4.0 * kPi / (2.0 * kRows * kRows);
      EXPECT_NEAR(reflection * cell, 1.0, 2e-4)
          << cosine;  // midpoint rule over lobes some 100 cells wide with an edge at wh.z = 0
      EXPECT_NEAR(lambert * cell, 1.0, 1e-5);
    }
  }
}

/// Mean of g(wi) / density over samples must be the integral of g, for a g that tells directions apart.
TEST(ReferenceBrdf, SamplesFollowTheirDensity) {
  const auto g = [](glm::dvec3 w) { return std::exp(2.0 * w.x - w.y) * (w.z > 0.0 ? w.z : 0.0); };
  double expected = 0.0;
  constexpr int kRows = 1000;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < 2 * kRows; ++j) expected += g(direction((i + 0.5) / kRows, kPi * (j + 0.5) / kRows));
  }
  expected *= 2.0 * kPi / (2.0 * kRows * kRows);
  const Brdf brdf{glm::dvec3(0.5), glm::dvec3(0.5), glm::dvec3(1.0), 0.9, 0.6};
  const glm::dvec3 wo = direction(0.5, 0.4);
  const PointSet points(5);
  double reflection = 0.0;
  double lambert = 0.0;
  constexpr int kSamples = 1 << 18;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const glm::dvec3 a = sampleReflection(brdf, wo, points.pair(i, 0));
    EXPECT_LE(std::abs(glm::length(a) - 1.0), 1e-12);
    reflection += g(a) / reflectionDensity(brdf, wo, a);
    const glm::dvec3 b = sampleCosine(points.pair(i, 1));
    lambert += g(b) / cosineDensity(b);
  }
  // Low-discrepancy points of a ratio that varies by about its own mean: observed 1e-5, random ones would give 2e-3.
  EXPECT_NEAR(reflection / kSamples / expected, 1.0, 1e-3);
  EXPECT_NEAR(lambert / kSamples / expected, 1.0, 1e-4);
}

TEST(ReferenceBrdf, WhiteFurnaceLosesOnlyWhatSingleScatteringLoses) {
  for (const double alpha : {0.1, 0.2, 0.6, 1.0}) {
    for (const double alphaY : {alpha, 0.5 * alpha}) {
      const Brdf brdf{glm::dvec3(0.0), glm::dvec3(1.0), glm::dvec3(1.0), alpha, alphaY};
      for (const double cosine : {0.1, 0.5, 0.95}) {
        const glm::dvec3 wo = direction(cosine, 0.6);
        const PointSet points(9);
        double sum = 0.0;
        constexpr int kSamples = 1 << 16;
        for (std::uint32_t i = 0; i < kSamples; ++i) {
          const glm::dvec3 wi = sampleReflection(brdf, wo, points.pair(i, 0));
          const double density = reflectionDensity(brdf, wo, wi);
          if (wi.z > 0.0) sum += brdfTimesCosine(brdf, wo, wi).x / density;
        }
        const double albedo = sum / kSamples;
        EXPECT_LE(albedo, 1.0 + 1e-9);
        EXPECT_NEAR(albedo, furnace(alpha, alphaY, wo), 2e-4)
            << alpha << " " << alphaY << " " << cosine;  // both are good to 1e-4
      }
    }
  }
}

TEST(ReferenceSampling, EveryAlignedBlockIsANet) {
  const PointSet points(77);
  for (std::uint32_t sequence = 0; sequence < PointSet::kSequences; ++sequence) {
    for (std::uint32_t block = 0; block < 4; ++block) {
      for (int across = 0; across <= 6; ++across) {
        // 64 points, 64 boxes of 2^across columns and 2^(6 - across) rows: one point in each.
        const int columns = 1 << across;
        const int rows = 64 / columns;
        std::array<int, 64> count{};
        for (std::uint32_t i = 0; i < 64; ++i) {
          const glm::dvec2 p = points.pair(64 * block + i, sequence);
          ASSERT_TRUE(p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0);
          EXPECT_EQ(points.single(64 * block + i, sequence), p.x);
          count[static_cast<std::size_t>(static_cast<int>(p.y * rows) * columns + static_cast<int>(p.x * columns))]++;
        }
        for (const int n : count) EXPECT_EQ(n, 1);
      }
    }
  }
}

TEST(ShadingNormal, IsNeverTurnedAwayFromTheViewer) {
  std::mt19937 random(11);
  std::normal_distribution<double> gaussian;
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 wo = glm::normalize(glm::dvec3(gaussian(random), gaussian(random), gaussian(random)));
    const glm::dvec3 normal = glm::normalize(glm::dvec3(gaussian(random), gaussian(random), gaussian(random)));
    const glm::dvec3 bent = shadingNormalTowards(normal, wo);
    EXPECT_LE(std::abs(glm::length(bent) - 1.0), 1e-12);
    EXPECT_GE(glm::dot(bent, wo), kMinViewCosine * (1.0 - 2e-6));
    if (glm::dot(normal, wo) >= kMinViewCosine) {
      EXPECT_EQ(bent, normal);
    } else {
      EXPECT_GE(glm::dot(bent, normal), glm::dot(wo, normal));  // no further round than the viewer
    }
  }
  const glm::dvec3 wo(0.0, 0.0, 1.0);
  EXPECT_LE(glm::length(shadingNormalTowards(-wo, wo) - wo), 1e-12);
}

}  // namespace
}  // namespace chiaro::reference
