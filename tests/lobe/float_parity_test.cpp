/// Float C++ against double C++ over every function and the whole stated domain: is the form stable?

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/lobe/parity.h"

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
  EXPECT_EQ(compare(c, expected, got, "0.1 %").failures, 1u);
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
