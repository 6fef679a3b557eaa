// The reference's reflectance models beside those of shaders/lobe, which were written apart from them; sampling, coat and energy.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "precompute/reference/brdf.h"
#include "precompute/reference/sampling.h"
#include "shaders/cpp/lobe.h"

namespace chiaro::reference {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Reflectance kAll[] = {Reflectance::ggx,        Reflectance::cookTorrance, Reflectance::beckmann,
                                Reflectance::blinnPhong, Reflectance::ward,         Reflectance::ashikhminShirley};

int lobeKind(Reflectance model) {
  switch (model) {
    case Reflectance::ggx: return lobe64::kGgx;
    case Reflectance::cookTorrance: return lobe64::kCookTorrance;
    case Reflectance::beckmann: return lobe64::kBeckmann;
    case Reflectance::blinnPhong: return lobe64::kBlinnPhong;
    case Reflectance::ward: return lobe64::kWard;
    case Reflectance::ashikhminShirley: return lobe64::kAshikhminShirley;
  }
  return -1;
}

glm::dvec3 direction(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

Brdf brdfOf(Reflectance model, double alphaX, double alphaY) {
  Brdf brdf{glm::dvec3(0.0), glm::dvec3(1.0), glm::dvec3(1.0), alphaX, isRound(model) ? alphaX : alphaY};
  brdf.model = model;
  return brdf;
}

/// Mean over the sphere times 4 pi, of g(wi), by the midpoint rule.
template <class G>
double overSphere(int rows, G g) {
  double sum = 0.0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 2 * rows; ++j) sum += g(direction(1.0 - 2.0 * (i + 0.5) / rows, kPi * (j + 0.5) / rows));
  return sum * 4.0 * kPi / (2.0 * rows * rows);
}

/// Light that comes back to wo from a white sphere, by the brdf's own samples.
glm::dvec3 furnace(const Brdf& brdf, glm::dvec3 wo) {
  const PointSet points(9);
  constexpr int kSamples = 1 << 15;
  const double coat = coatShare(brdf, wo), reflect = (1.0 - coat) * 0.5, lambert = 1.0 - coat - reflect;
  glm::dvec3 sum(0.0);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const double choice = points.single(i, 2);
    const glm::dvec2 random = points.pair(i, 1);
    const glm::dvec3 wi = choice < reflect          ? sampleReflection(brdf, wo, random)
                          : choice < reflect + coat ? sampleCoat(brdf, wo, random)
                                                    : sampleCosine(random);
    double density = reflect * reflectionDensity(brdf, wo, wi) + lambert * cosineDensity(wi);
    if (coat > 0.0) density += coat * coatDensity(brdf, wo, wi);
    if (density > 0.0) sum += brdfTimesCosine(brdf, wo, wi) / density;
  }
  return sum / static_cast<double>(kSamples);
}

TEST(ReferenceModels, AgreeWithTheLobesWrittenApartFromThem) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  for (const Reflectance model : kAll) {
    double worst = 0.0;
    int lit = 0;
    for (int i = 0; i < 20000; ++i) {
      Brdf brdf = brdfOf(model, std::pow(10.0, -2.5 * uniform(random)), std::pow(10.0, -2.5 * uniform(random)));
      brdf.f0 = {uniform(random), uniform(random), uniform(random)};
      const glm::dvec3 wo = direction(1e-3 + 0.999 * uniform(random), 2.0 * kPi * uniform(random));
      glm::dvec3 wi = direction(1e-3 + 0.999 * uniform(random), 2.0 * kPi * uniform(random));
      if (uniform(random) < 0.7) wi = sampleReflection(brdf, wo, {1.0 - uniform(random), uniform(random)});  // where there is something to see
      const auto parameter = [&](double alpha) { return hasExponent(model) ? 2.0 / (alpha * alpha) - 2.0 : alpha; };
      const glm::dvec3 expected =
          lobe64::reflectanceTimesCosine(lobe64::reflectanceModel(lobeKind(model), parameter(brdf.alphaX), parameter(brdf.alphaY)), brdf.f0, wo, wi);
      const glm::dvec3 got = brdfTimesCosine(brdf, wo, wi);
      if (!(wi.z > 1e-3)) continue;
      lit += expected.x > 1e-6;
      for (int c = 0; c < 3; ++c) {
        const double error = std::abs(got[c] - expected[c]) / std::max(expected[c], 1e-12);
        if (!(error <= worst)) worst = error;
      }
    }
    // The lobes' logarithm and complementary error function are good to 1e-8 and 1e-6 and stand in an exponent, or are what is left of a difference.
    EXPECT_LE(worst, model == Reflectance::ggx ? 1e-11 : 2e-5) << static_cast<int>(model);
    EXPECT_GE(lit, 8000) << static_cast<int>(model);
  }
}

TEST(ReferenceModels, AreReciprocal) {
  const glm::dvec3 a = direction(0.8, 0.3), b = direction(0.15, 2.0);
  for (const Reflectance model : kAll) {
    Brdf brdf = brdfOf(model, 0.6, 0.2);
    brdf.diffuse = {0.3, 0.5, 0.7};
    brdf.f0 = {0.04, 0.5, 0.9};
    const glm::dvec3 difference = brdfTimesCosine(brdf, a, b) / b.z - brdfTimesCosine(brdf, b, a) / a.z;
    EXPECT_LE(glm::length(difference), 1e-13) << static_cast<int>(model);
    EXPECT_EQ(brdfTimesCosine(brdf, a, {0.6, 0.0, -0.8}), glm::dvec3(0.0));
    EXPECT_EQ(brdfTimesCosine(brdf, {0.6, 0.0, -0.8}, a), glm::dvec3(0.0));
  }
}

TEST(ReferenceModels, DensitiesIntegrateToOne) {
  for (const Reflectance model : kAll)
    for (const auto& [x, y] : {std::pair{0.3, 0.3}, {0.8, 0.25}})
      for (const double cosine : {0.05, 0.6, 1.0}) {
        const Brdf brdf = brdfOf(model, x, y);
        const glm::dvec3 wo = direction(cosine, 0.7);
        const double total = overSphere(1000, [&](glm::dvec3 wi) { return reflectionDensity(brdf, wo, wi); });
        // The midpoint rule over lobes a hundred cells wide; where the view grazes, over one that is a few cells high.
        EXPECT_NEAR(total, 1.0, cosine < 0.1 ? 1e-2 : 2e-3) << static_cast<int>(model) << ' ' << x << ' ' << y << ' ' << cosine;
      }
}

/// Mean of g(wi) / density over samples must be the integral of g.
TEST(ReferenceModels, SamplesFollowTheirDensities) {
  const auto g = [](glm::dvec3 w) { return std::exp(2.0 * w.x - w.y) * std::max(w.z, 0.0); };
  const double expected = overSphere(1000, g);
  const glm::dvec3 wo = direction(0.7, 0.4);
  const PointSet points(5);
  constexpr int kSamples = 1 << 17;
  for (const Reflectance model : kAll) {
    const Brdf brdf = brdfOf(model, 0.8, 0.6);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const glm::dvec3 wi = sampleReflection(brdf, wo, points.pair(i, 0));
      EXPECT_LE(std::abs(glm::length(wi) - 1.0), 1e-12);
      if (g(wi) > 0.0) sum += g(wi) / reflectionDensity(brdf, wo, wi);
    }
    // Where the density is small the ratio is large: half vectors seldom make directions near the horizon.
    EXPECT_NEAR(sum / kSamples / expected, 1.0, 2e-2) << static_cast<int>(model);
  }
  Brdf coated;
  coated.coat = 1.0;
  coated.coatAlpha = 0.7;
  coated.coatNormal = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));
  double sum = 0.0;
  const auto inCoat = [&](glm::dvec3 w) { return std::exp(2.0 * w.x - w.y) * std::max(glm::dot(w, coated.coatNormal), 0.0); };
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const glm::dvec3 wi = sampleCoat(coated, wo, points.pair(i, 0));
    if (inCoat(wi) > 0.0) sum += inCoat(wi) / coatDensity(coated, wo, wi);
  }
  EXPECT_NEAR(sum / kSamples / overSphere(1000, inCoat), 1.0, 2e-3);
  EXPECT_NEAR(overSphere(1000, [&](glm::dvec3 wi) { return coatDensity(coated, wo, wi); }), 1.0, 1e-3);
}

// What comes back of uniform light: never more than came, but for Ward and the groove masking at grazing views (shaders/lobe/ndf.glsl).
TEST(ReferenceModels, WhiteFurnace) {
  for (const Reflectance model : kAll)
    for (const double alpha : {0.03, 0.3, 1.0})
      for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
        const Brdf brdf = brdfOf(model, alpha, 0.5 * alpha);
        const double albedo = furnace(brdf, direction(cosine, 0.6)).x;
        EXPECT_GT(albedo, 0.0);
        const bool gains = model == Reflectance::ward || model == Reflectance::cookTorrance;
        if (!gains) {
          EXPECT_LE(albedo, 1.004) << static_cast<int>(model) << ' ' << alpha << ' ' << cosine;  // Blinn-Phong's own 1.003
        }
        if (gains && cosine > 0.5) {
          EXPECT_LE(albedo, 1.004) << static_cast<int>(model) << ' ' << alpha << ' ' << cosine;
        }
      }
}

// A coat over a white metal: what it does not reflect goes on, so all comes back but what rough GGX loses.
TEST(ReferenceModels, ACoatKeepsTheBalance) {
  for (const double cosine : {0.1, 0.5, 1.0}) {
    Brdf brdf = brdfOf(Reflectance::ggx, 0.01, 0.01);
    brdf.coat = 1.0;
    brdf.coatAlpha = 0.002;
    EXPECT_NEAR(furnace(brdf, direction(cosine, 0.3)).x, 1.0, 5e-3) << cosine;
    brdf.f0 = brdf.f90 = glm::dvec3(0.0);
    EXPECT_NEAR(furnace(brdf, direction(cosine, 0.3)).x, coatWeight(brdf, direction(cosine, 0.3)), 3e-3) << cosine;
  }
  Brdf brdf;
  brdf.coat = 0.5;
  EXPECT_NEAR(coatWeight(brdf, glm::dvec3(0, 0, 1)), 0.02, 1e-12);
  EXPECT_NEAR(coatWeight(brdf, glm::dvec3(1, 0, 0)), 0.5, 1e-12);
}

// With the gain of multiple scattering a white GGX metal of any roughness gives everything back.
TEST(ReferenceModels, CompensationClosesTheFurnace) {
  for (const double alpha : {0.05, 0.3, 0.7, 1.0})
    for (const double ratio : {1.0, 0.3})
      for (const double cosine : {0.1, 0.3, 0.5, 0.95}) {
        Brdf brdf = brdfOf(Reflectance::ggx, alpha, ratio * alpha);
        const glm::dvec3 wo = direction(cosine, 0.6);
        const double lost = furnace(brdf, wo).x;
        EXPECT_LE(lost, 1.0 + 1e-3);
        EXPECT_NEAR(ggxAlbedo(brdf, wo), lost, 5e-3) << alpha << ' ' << ratio << ' ' << cosine;
        brdf.gain = multipleScatteringGain(brdf, wo);
        EXPECT_NEAR(furnace(brdf, wo).x, 1.0, 1e-2) << alpha << ' ' << ratio << ' ' << cosine;
        brdf.f0 = glm::dvec3(0.04);  // a dielectric gains as little as it reflects
        EXPECT_LE(multipleScatteringGain(brdf, wo).x, 1.0 + 0.04 * (1.0 / lost - 1.0) + 1e-3);
      }
  EXPECT_EQ(multipleScatteringGain(brdfOf(Reflectance::ward, 1.0, 1.0), direction(0.5, 0.0)), glm::dvec3(1.0));
}

}  // namespace
}  // namespace chiaro::reference
