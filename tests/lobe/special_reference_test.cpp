/// Double C++ against the standard library and quadrature: are our special functions right?

#include <gtest/gtest.h>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using namespace lobe64;

TEST(Special, OneMinusExpOverMatchesExpm1) {
  EXPECT_EQ(oneMinusExpOver(0.0), 1.0);
  EXPECT_NEAR(oneMinusExpOver(1.0), 0.632120559, 1e-9);
  EXPECT_NEAR(oneMinusExpOver(10.0), 0.0999954600, 1e-10);
  for (double x = 1e-12; x < 1e12; x *= 1.07) {
    const double expected = -std::expm1(-x) / x;
    EXPECT_NEAR(oneMinusExpOver(x) / expected, 1.0, 1e-9) << x;
    EXPECT_NEAR(oneMinusExp(x) / -std::expm1(-x), 1.0, 1e-9) << x;
  }
}

TEST(Special, ErrorFunctionMatchesTheStandardOne) {
  for (double x = -7; x <= 7; x += 0.0137) EXPECT_NEAR(errorFunction(x), std::erf(x), 3e-9 * std::abs(std::erf(x)) + 1e-300) << x;
}

// e^(x^2) erfc(x) = 2/sqrt(pi) int exp(-u^2 - 2 u x) du, and its integral with a factor u: both by quadrature.
TEST(Special, ScaledErfcsMatchTheirIntegrals) {
  for (double x = 0; x < 100; x = x * 1.1 + 0.01) {
    const double reach = 50 / (x + std::sqrt(x * x + 50));
    const auto integral = [&](int power) {
      return 2 / std::sqrt(quadrature::kPi) *
             quadrature::integrate([&](double u) { return std::pow(u, power) * std::exp(-u * u - 2 * u * x); }, 0, reach, 10);
    };
    EXPECT_NEAR(erfcScaled(x) / integral(0), 1.0, 4e-9) << x;
    EXPECT_NEAR(erfcIntegralScaled(x) / integral(1), 1.0, 4e-9) << x;
  }
}

TEST(Special, ErfSeriesAndItsIntegral) {
  for (double x = 0.01; x <= 1; x += 0.01) {
    EXPECT_NEAR(x * erfOverArgument(x * x) / std::erf(x), 1.0, 1e-9);
    const double integral = x * std::erf(x) - (1 - std::exp(-x * x)) / std::sqrt(quadrature::kPi);
    EXPECT_NEAR(x * x * erfIntegralOverSquare(x * x), integral, 1e-9 * integral + 1e-16);
  }
}

TEST(Special, Trigonometry) {
  for (double x = -1; x <= 1; x += 0.00173) {
    EXPECT_NEAR(sinQuarter(x * kHalfPi), std::sin(x * kHalfPi), 1e-10);
    EXPECT_NEAR(sinPi(x), std::sin(quadrature::kPi * x), 1e-10);
    EXPECT_NEAR(cosPi(x), std::cos(quadrature::kPi * x), 1e-10);
  }
  for (double angle = 1e-6; angle < 1.5707; angle += 0.0031) EXPECT_NEAR(atanQuadrant(std::sin(angle), std::cos(angle)) / angle, 1.0, 2e-10);
  EXPECT_NEAR(atanQuadrant(1.0, 0.0), 0.5 * quadrature::kPi, 1e-15);
  EXPECT_EQ(atanQuadrant(0.0, 1.0), 0.0);
  EXPECT_TRUE(std::isnan(atanQuadrant(0.0, 0.0)));
}

}  // namespace
}  // namespace chiaro
