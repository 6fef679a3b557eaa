/// Float C++ against double C++ over every function and the whole stated domain: is the form stable?

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/lobe/extreme_models.h"
#include "shaders/parity/parity.h"

namespace chiaro::parity {
namespace {

class FloatParity : public testing::TestWithParam<std::size_t> {};

TEST_P(FloatParity, MatchesDouble) {
  const Case& c = allCases()[GetParam()];
  ASSERT_GE(c.sampleCount(), 65536u);
  const Comparison result = compare(c, runDouble(c), runFloat(c), "float C++");
  std::fputs(result.report.c_str(), stdout);
  EXPECT_EQ(result.failures, 0u) << result.report;
  EXPECT_LE(result.worst, c.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Lobe, FloatParity, testing::Range(std::size_t{0}, allCases().size()),
                         [](const auto& index) { return allCases()[index.param].name; });

// A million models at their ends, seen and lit from the ends of all directions.
TEST(Extremes, ModelsAreFiniteAndNeverNegative) {
  const Case c = extremeModels();
  const auto radiance = runFloat(c);
  EXPECT_EQ(countBad(radiance), 0u) << firstBad(c, radiance);
  EXPECT_GT(countLit(radiance), c.sampleCount());
  const auto wide = runDouble(c);
  EXPECT_EQ(countBad(wide), 0u) << firstBad(c, wide);
  EXPECT_GT(countLit(wide), c.sampleCount());
}

// Where float is weakest: the worst relative error by decade of sharpness, of the stable forms and of the textbook ones that they replace.
// The textbook columns show that the inputs are hard enough to tell: they must be bad where ours are good.
TEST(Stability, TableBySharpness) {
  std::printf("%-10s %12s %12s %12s %12s\n", "sharpness", "evaluate", "textbook", "inner prod.", "textbook");
  double worstTextbook = 0;
  for (double low = 1e-6; low < 0.99e6; low *= 10) {
    double evaluate = 0, evaluateTextbook = 0, inner = 0, innerTextbook = 0;
    for (int i = 0; i < 20000; ++i) {
      // A deterministic scatter: golden-ratio steps in sharpness, angle and azimuth.
      const double u = std::fmod(i * 0.618033988749895, 1.0), v = std::fmod(i * 0.754877666246693, 1.0), w = std::fmod(i * 0.569840290998053, 1.0);
      const auto l = static_cast<float>(low * std::pow(10.0, u));
      const double angle = 2 * std::asin(std::min(1.0, std::sqrt(8 * v / l))), phi = 6.283 * w;
      const glm::vec3 a(0.48f, 0.6f, 0.64f);
      const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(a), glm::dvec3(1, 0, 0))), y = glm::cross(glm::dvec3(a), x);
      const glm::vec3 b(std::cos(angle) * glm::dvec3(a) + std::sin(angle) * (std::cos(phi) * x + std::sin(phi) * y));
      const auto error = [](double got, double expected) { return std::abs(got - expected) / std::max(std::abs(expected), kFloor); };
      const auto raise = [](double& worst, double e) { worst = e <= worst ? worst : e; };

      const double value = lobe64::sgEvaluate(lobe64::sphericalGaussian(a, l, 1), b);
      raise(evaluate, error(lobe32::sgEvaluate(lobe32::sphericalGaussian(a, l, 1), b), value));
      raise(evaluateTextbook, error(std::exp(l * (glm::dot(a, b) - 1.0f)), value));

      const double product = lobe64::sgInnerProduct(lobe64::sphericalGaussian(a, l, 1), lobe64::sphericalGaussian(b, l, 1));
      raise(inner, error(lobe32::sgInnerProduct(lobe32::sphericalGaussian(a, l, 1), lobe32::sphericalGaussian(b, l, 1)), product));
      const float d = glm::length(l * a + l * b);
      raise(innerTextbook, error(6.28318531f * std::exp(d - 2 * l) * (1.0f - std::exp(-2 * d)) / d, product));
    }
    std::printf("%-10.0e %12.2e %12.2e %12.2e %12.2e\n", low, evaluate, evaluateTextbook, inner, innerTextbook);
    EXPECT_LE(evaluate, kTolerance);
    EXPECT_LE(inner, kTolerance);
    worstTextbook = std::max(worstTextbook, std::min(evaluateTextbook, innerTextbook));
  }
  EXPECT_GT(worstTextbook, 1e-3);
}

// The comparison itself: NaN, a wrong sign of infinity and 0.1 % must all be seen.
TEST(Compare, SeesWhatIsWrong) {
  const Case& c = allCases().front();
  const std::vector<double> expected = runDouble(c);
  std::vector<float> got = runFloat(c);
  ASSERT_EQ(compare(c, expected, got, "as is").failures, 0u);
  std::size_t finite = 0;
  while (!(expected[finite] > 0.01)) ++finite;
  const float right = got[finite];
  got[finite] = right * 1.001f;
  const Comparison wrong = compare(c, expected, got, "0.1 %");
  EXPECT_EQ(wrong.failures, 1u);
  EXPECT_EQ(wrong.worstSample * static_cast<std::size_t>(c.outputCount), finite - finite % static_cast<std::size_t>(c.outputCount));
  // A relative error of .001 is between .001 2^23 and .001 2^24 steps.
  EXPECT_TRUE(wrong.worstUlps > 8300.0 && wrong.worstUlps < 16800.0) << wrong.worstUlps;
  got[finite] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compare(c, expected, got, "NaN for a number").failures, 1u);
  got[finite] = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(compare(c, expected, got, "infinity for a number").failures, 1u);
  got[finite] = right;
  std::size_t nan = 0;
  while (expected[nan] == expected[nan]) ++nan;
  got[nan] = 0.5f;
  EXPECT_EQ(compare(c, expected, got, "a number for NaN").failures, 1u);
  got.pop_back();
  EXPECT_GT(compare(c, expected, got, "too few").failures, 0u);
}

}  // namespace
}  // namespace chiaro::parity
