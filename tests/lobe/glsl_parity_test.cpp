/// GLSL on this machine's driver against double C++ over every function and the whole stated domain: did the compiler, the driver or
/// our dialect change anything?

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/parity/run_glsl.h"
#include "tests/lobe/extreme_models.h"
#include "shaders/parity/parity.h"
#include "tests/lobe/gl_test_main.h"

namespace chiaro::parity {
namespace {

const Case& caseNamed(const std::string& name) {
  return *std::find_if(allCases().begin(), allCases().end(), [&](const Case& c) { return c.name == name; });
}

class GlslParity : public testing::TestWithParam<std::size_t> {};

TEST_P(GlslParity, MatchesDouble) {
  const Case& c = allCases()[GetParam()];
  ASSERT_GE(c.sampleCount(), 65536u);
  const Comparison result = compare(c, runDouble(c), runGlsl(c, gl::readEmbeddedShader), "GLSL");
  std::fputs(result.report.c_str(), stdout);
  EXPECT_EQ(result.failures, 0u) << result.report;
  EXPECT_LE(result.worst, c.tolerance);
  EXPECT_TRUE(testContext().debugLog().messages().empty());
}

INSTANTIATE_TEST_SUITE_P(Lobe, GlslParity, testing::Range(std::size_t{0}, allCases().size()),
                         [](const auto& index) { return allCases()[index.param].name; });

// A million models at their ends, seen and lit from the ends of all directions (float C++ and double: float_parity_test.cpp).
TEST(GlslExtremes, ModelsAreFiniteAndNeverNegative) {
  const Case c = extremeModels();
  const auto radiance = runGlsl(c, gl::readEmbeddedShader);
  EXPECT_EQ(countBad(radiance), 0u) << firstBad(c, radiance);
  EXPECT_GT(countLit(radiance), c.sampleCount());
}

// A test of the test: one constant 0.1 % off in the GLSL alone must be found.
TEST(GlslParityTest, FindsABrokenConstant) {
  const auto broken = [](const std::string& file, const std::string& right, const std::string& wrong) {
    return [=](const std::string& name) {
      std::optional<std::string> text = gl::readEmbeddedShader(name);
      if (name == file && text) {
        const std::size_t at = text->find(right);
        EXPECT_NE(at, std::string::npos) << "the constant to break is gone from " << file;
        if (at != std::string::npos) text->replace(at, right.size(), wrong);
      }
      return text;
    };
  };
  const auto failures = [](const std::string& name, const gl::ShaderReader& reader) {
    const Case& c = caseNamed(name);
    const Comparison result = compare(c, runDouble(c), runGlsl(c, reader), "broken");
    std::fputs(result.report.c_str(), stdout);
    return result.failures;
  };
  EXPECT_GT(failures("sgIntegral", broken("shaders/lobe/special.glsl", "12.5663706", "12.5789370")), 1000u);
  EXPECT_GT(failures("sgHalfSpaceFraction", broken("shaders/lobe/half_space.glsl", "t2 = l * (Real(0.6328125)", "t2 = l * (Real(0.6334453)")), 1000u);
  EXPECT_GT(failures("shEvaluate", broken("shaders/lobe/sh.glsl", "0.4570457994", "0.4575028452")), 1000u);
  EXPECT_GT(failures("ggxMixtureLobes", broken("shaders/lobe/ggx.glsl", "Real(0.87782)", "Real(0.87870)")), 1000u);
}

}  // namespace
}  // namespace chiaro::parity
