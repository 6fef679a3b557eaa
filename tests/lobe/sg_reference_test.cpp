/// Double C++ against quadrature and values computed elsewhere: are the SG formulas right?

#include <gtest/gtest.h>

#include <random>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using namespace lobe64;

const Vec3 kUp(0, 0, 1);

Vec3 at(double angle, double azimuth = 0.3) { return Vec3(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)); }

TEST(Sg, EvaluateIsTheDefinition) {
  for (double l : {0.0, 0.7, 13.0, 4000.0}) {
    for (double angle : {0.0, 0.01, 0.4, 2.0, 3.1}) {
      const double expected = 2.5 * std::exp(l * (std::cos(angle) - 1));
      EXPECT_NEAR(sgEvaluate(sphericalGaussian(kUp, l, 2.5), at(angle)), expected, 1e-10 * expected + 1e-300);
    }
  }
}

TEST(Sg, IntegralAndNormByQuadrature) {
  for (double l : {0.0, 1e-6, 0.3, 1.0, 7.0, 100.0, 1e4, 1e6}) {
    const SphericalGaussian g = sphericalGaussian(kUp, l, 1.7);
    const double integral = 1.7 * quadrature::lobeAboutPole(l, 0, 0, quadrature::kPi, [](double) { return 1.0; });
    EXPECT_NEAR(sgIntegral(g) / integral, 1.0, 1e-9) << l;
    const double square = 1.7 * 1.7 * quadrature::lobeAboutPole(2 * l, 0, 0, quadrature::kPi, [](double) { return 1.0; });
    EXPECT_NEAR(sgNorm(g) / std::sqrt(square), 1.0, 1e-9) << l;
  }
}

TEST(Sg, ProductIsThePointwiseProduct) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double l1 = std::exp(12 * uniform(engine) - 4), l2 = std::exp(12 * uniform(engine) - 4);
    const double spread = 3.1 * uniform(engine) / std::sqrt(1 + std::min(l1, l2));
    const SphericalGaussian a = sphericalGaussian(at(1.0), l1, 0.8), b = sphericalGaussian(at(1.0 + spread, 0.3 + 0.2 * spread), l2, 1.9);
    const SphericalGaussian p = sgProduct(a, b);
    const Vec3 w = at(1.0 + spread * uniform(engine), 0.3 + 0.2 * uniform(engine));
    const double expected = 0.8 * 1.9 * std::exp(l1 * (glm::dot(a.axis, w) - 1) + l2 * (glm::dot(b.axis, w) - 1));
    EXPECT_NEAR(sgEvaluate(p, w), expected, 1e-8 * expected + 1e-250);
  }
}

TEST(Sg, ProductAtItsEdges) {
  const SphericalGaussian opposite = sgProduct(sphericalGaussian(kUp, 5, 1), sphericalGaussian(-kUp, 5, 1));
  EXPECT_EQ(opposite.sharpness, 0.0);
  EXPECT_EQ(opposite.axis, kUp);
  EXPECT_NEAR(opposite.amplitude, std::exp(-10.0), 1e-18);
  const SphericalGaussian uneven = sgProduct(sphericalGaussian(kUp, 3, 1), sphericalGaussian(-kUp, 5, 1));
  EXPECT_NEAR(uneven.sharpness, 2.0, 1e-14);
  EXPECT_NEAR(uneven.axis.z, -1.0, 1e-14);
  EXPECT_NEAR(uneven.amplitude, std::exp(-6.0), 1e-15);
  const SphericalGaussian constants = sgProduct(sphericalGaussian(kUp, 0, 2), sphericalGaussian(at(1), 0, 3));
  EXPECT_EQ(constants.sharpness, 0.0);
  EXPECT_EQ(constants.amplitude, 6.0);
  const SphericalGaussian equal = sgProduct(sphericalGaussian(kUp, 1e6, 1), sphericalGaussian(kUp, 1e3, 1));
  EXPECT_EQ(equal.amplitude, 1.0);
  EXPECT_NEAR(equal.sharpness, 1.001e6, 1e-6);
}

struct Pair {
  double l1, l2, angle, value;
};

// Values of ALGORITHMS 1.4, which were checked there by 2-D quadrature; the digits printed there bound the comparison.
TEST(Sg, InnerProductTable) {
  for (const Pair& p : {Pair{0, 0, 1, 12.5663706}, Pair{1, 2, .5, 1.97694858}, Pair{10, 10, .3, .253817137}, Pair{10, 40, 0, .125663706},
                        Pair{1000, 1000, .05, 1.68215376e-3}, Pair{3, 3, quadrature::kPi, 3.11489185e-2}, Pair{1e6, 1e6, 1e-3, 2.44667514e-6}}) {
    EXPECT_NEAR(sgInnerProduct(sphericalGaussian(kUp, p.l1, 1), sphericalGaussian(at(p.angle), p.l2, 1)) / p.value, 1.0, 5e-9) << p.l1;
  }
}

// And our own: polar coordinates about the first axis, azimuth by Bessel.
TEST(Sg, InnerProductByQuadrature) {
  for (double l1 : {0.0, 0.5, 4.0, 60.0, 3000.0}) {
    for (double l2 : {0.2, 4.0, 100.0}) {
      for (double angle : {0.0, 0.2, 1.1, 3.0}) {
        // About the broader lobe's axis; the sharper one decides where to look.
        const double integral = quadrature::lobeAboutPole(std::max(l1, l2), angle, 0, quadrature::kPi, [&](double theta) {
          const double s = std::sin(0.5 * theta);
          return std::exp(-2 * std::min(l1, l2) * s * s);
        });
        const double value = sgInnerProduct(sphericalGaussian(kUp, l1, 1), sphericalGaussian(at(angle), l2, 1));
        // The quadrature keeps 12 deviations of the sharper lobe: what it drops is below e^-72 of the peak.
        EXPECT_NEAR(value, integral, 1e-9 * integral + 1e-28) << l1 << ' ' << l2 << ' ' << angle;
      }
    }
  }
}

// Long after the weight is 0: a quarter of sharpness times the squared chord.
TEST(Sg, LobeDistanceGoesOnBeyondTheWeight) {
  for (const double angle : {0.1, 1.0, 3.0}) {
    const double chord = 2.0 * std::sin(0.5 * angle);
    EXPECT_EQ(lobeWeight(kUp, 1e6, at(angle), 1e6), 0.0);
    // Of that the logarithm of the product's sharpness, less than log(1e6), is not in the formula.
    EXPECT_NEAR(lobeDistance(kUp, 1e6, at(angle), 1e6), 1e6 * (1.0 - std::sqrt(1.0 - 0.25 * chord * chord)) * 2.0, 15.0);
    EXPECT_GT(lobeNearness(kUp, 1e6, at(angle), 1e6), 0.0);
    EXPECT_LT(lobeNearness(kUp, 1e6, at(angle), 1e6), lobeNearness(kUp, 1e6, at(0.5 * angle), 1e6));
  }
  EXPECT_EQ(lobeNearness(kUp, 7.0, kUp, 7.0), 1.0);
}

TEST(Sg, NormalizedInnerProductTable) {
  for (const Pair& p : {Pair{0, 0, 1, 1}, Pair{0, 5, 1, .447193292}, Pair{1, 1, quadrature::kPi, .55144113}, Pair{5, 5, quadrature::kPi, 9.07998597e-4},
                        Pair{10, 10, .3, .807925038}, Pair{10, 40, 0, .8}, Pair{1023, 1023, .05, .527804585}, Pair{1e6, 1e6, 1e-3, .778800884},
                        Pair{1e6, 1e4, 1e-3, .197041929}}) {
    const SphericalGaussian a = sphericalGaussian(kUp, p.l1, 3), b = sphericalGaussian(at(p.angle), p.l2, -7);
    EXPECT_NEAR(sgNormalizedInnerProduct(a, b) / p.value, 1.0, 5e-9);
    EXPECT_EQ(sgNormalizedInnerProduct(a, b), sgNormalizedInnerProduct(b, a));
    EXPECT_NEAR(sgNormalizedInnerProduct(a, a), 1.0, 1e-9);
    EXPECT_EQ(lobeWeight(a.axis, a.sharpness, b.axis, b.sharpness), sgNormalizedInnerProduct(a, b));
    EXPECT_NEAR(lobeDistance(a.axis, a.sharpness, b.axis, b.sharpness), -std::log(p.value), 1e-8);
    EXPECT_NEAR(std::abs(sgInnerProduct(a, b)) / (sgNorm(a) * sgNorm(b)) / p.value, 1.0, 5e-9);
  }
}

TEST(Vmf, IntegratesToOneAndHasItsMeanCosine) {
  for (double l : {1e-9, 0.01, 0.69, 0.71, 3.0, 50.0, 1e5}) {
    EXPECT_NEAR(vmfAmplitude(l) * sgUnitIntegral(l), 1.0, 1e-9);
    const double mean = quadrature::lobeAboutPole(l, 0, 0, quadrature::kPi, [](double t) { return std::cos(t); }) / sgUnitIntegral(l);
    EXPECT_NEAR(vmfMeanCosine(l), mean, 2e-10) << l;
    const double deficit = quadrature::lobeAboutPole(l, 0, 0, quadrature::kPi, [](double t) { return 2 * std::pow(std::sin(t / 2), 2); }) / sgUnitIntegral(l);
    EXPECT_NEAR(oneMinusMeanCosine(l) / deficit, 1.0, 1e-8) << l;
  }
  EXPECT_NEAR(vmfMeanCosine(1e-6) / (1e-6 / 3), 1.0, 1e-9);
}

TEST(Vmf, InverseReturnsTheSharpness) {
  for (double l = 1e-6; l < 2e5; l *= 1.13) EXPECT_NEAR(vmfSharpnessFromMeanCosine(vmfMeanCosine(l)) / l, 1.0, 1e-8 + 1e-15 * l) << l;
  EXPECT_EQ(vmfSharpnessFromMeanCosine(0.0), 0.0);
  EXPECT_TRUE(std::isinf(vmfSharpnessFromMeanCosine(1.0)));
  EXPECT_TRUE(std::isnan(vmfSharpnessFromMeanCosine(1.1)));
  EXPECT_TRUE(std::isnan(vmfSharpnessFromMeanCosine(-0.1)));
}

// The convolution at angle gamma is the inner product of the kernel turned there with the lobe: compared in L2 with the table of
// ALGORITHMS 1.7 (the rule in use: first moment below 3, harmonic above), whose entries have one to three digits.
TEST(Sg, ConvolutionKeepsTheIntegralAndTheShape) {
  struct Row {
    double l1, l2, error, digits;
  };
  for (const Row& row : {Row{.5, .5, .0004, .00006}, Row{1, 1, .005, .0006}, Row{2, 2, .029, .001}, Row{5, 5, .035, .001}, Row{10, 10, .019, .001},
                         Row{10, 100, .003, .0006}, Row{100, 100, .002, .0006}}) {
    const SphericalGaussian a = sphericalGaussian(kUp, row.l1, 1.5), b = sphericalGaussian(at(2), row.l2, 0.4);
    const SphericalGaussian c = sgConvolve(a, b);
    EXPECT_EQ(c.axis, a.axis);
    EXPECT_NEAR(sgIntegral(c) / (sgIntegral(a) * sgIntegral(b)), 1.0, 1e-9);
    const auto exact = [&](double gamma) { return sgInnerProduct(a, sphericalGaussian(at(gamma), row.l2, 0.4)); };
    const double difference = quadrature::integrate([&](double t) { return std::sin(t) * std::pow(sgEvaluate(c, at(t)) - exact(t), 2); }, 0, quadrature::kPi, 30);
    const double norm = quadrature::integrate([&](double t) { return std::sin(t) * std::pow(exact(t), 2); }, 0, quadrature::kPi, 30);
    EXPECT_NEAR(std::sqrt(difference / norm), row.error, row.digits) << row.l1 << ' ' << row.l2;
  }
}

TEST(Sg, NonFiniteAndNegativeSharpness) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (double bad : {nan, -1.0, -inf}) {
    EXPECT_TRUE(std::isnan(sgIntegral(sphericalGaussian(kUp, bad, 1))));
    EXPECT_TRUE(std::isnan(sgEvaluate(sphericalGaussian(kUp, bad, 1), kUp)));
    EXPECT_TRUE(std::isnan(sgInnerProduct(sphericalGaussian(kUp, bad, 1), sphericalGaussian(kUp, 3, 1))));
    EXPECT_TRUE(std::isnan(sgInnerProduct(sphericalGaussian(kUp, 3, 1), sphericalGaussian(kUp, bad, 1))));
    EXPECT_TRUE(std::isnan(sgHalfSpaceFraction(0.1, bad)));
    EXPECT_TRUE(std::isnan(clampedCosineMean(0.1, bad)));
  }
  EXPECT_EQ(sgEvaluate(sphericalGaussian(kUp, inf, 2), kUp), 2.0);
  EXPECT_EQ(sgEvaluate(sphericalGaussian(kUp, inf, 2), at(1e-6)), 0.0);
}

}  // namespace
}  // namespace chiaro
