/// GLSL on this machine's driver against double C++ over every function and the whole stated domain: did the compiler, the driver or
/// our dialect change anything?

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "runtime/gl/buffer.h"
#include "runtime/gl/program.h"
#include "tests/lobe/extreme_models.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/lobe/parity.h"

namespace chiaro::parity {
namespace {

std::string kernelText() {
  const char* root = std::getenv("CHIARO_SOURCE_DIR");
  std::ifstream file(std::string(root == nullptr ? "." : root) + "/tests/lobe/kernels.glsl", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::optional<std::string> readShader(const std::string& name) {
  return name == "tests/lobe/kernels.glsl" ? std::optional(kernelText()) : gl::readEmbeddedShader(name);
}

/// Runs one kernel over all its inputs: one invocation a sample, inputs and outputs in storage buffers.
std::vector<float> runGlsl(const Case& c, const gl::ShaderReader& reader) {
  const std::string main = "#include \"tests/lobe/kernels.glsl\"\n"
      "layout(local_size_x = 64) in;\n"
      "layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };\n"
      "layout(std430, binding = 1) writeonly buffer Outputs { float outputs[]; };\n"
      "uniform uint sampleCount;\n"
      "void main() {\n"
      "  uint s = gl_GlobalInvocationID.x;\n"
      "  if (s >= sampleCount) return;\n"
      "  KernelInput x;\n"
      "  for (int i = 0; i < 12; ++i) x.v[i] = i < INPUTS ? inputs[s * INPUTS + i] : 0.0;\n"
      "  float y[25];\n"
      "  KERNEL_UNDER_TEST(x, y);\n"
      "  for (int i = 0; i < OUTPUTS; ++i) outputs[s * OUTPUTS + i] = y[i];\n"
      "}\n";
  const std::vector<std::string> defines{"KERNEL_UNDER_TEST kernel_" + c.name, "INPUTS " + std::to_string(c.inputCount),
                                         "OUTPUTS " + std::to_string(c.outputCount)};
  const gl::Program program = gl::Program::link({{GL_COMPUTE_SHADER, gl::resolveShaderText(c.name + ".comp", main, reader, defines)}});
  const gl::Buffer inputs(c.inputs);
  const gl::Buffer outputs(c.sampleCount() * static_cast<std::size_t>(c.outputCount) * sizeof(float));
  inputs.bindBase(GL_SHADER_STORAGE_BUFFER, 0);
  outputs.bindBase(GL_SHADER_STORAGE_BUFFER, 1);
  program.set("sampleCount", static_cast<unsigned>(c.sampleCount()));
  program.use();
  glDispatchCompute(static_cast<GLuint>((c.sampleCount() + 63) / 64), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  return outputs.read<float>();
}

const Case& caseNamed(const std::string& name) {
  return *std::find_if(allCases().begin(), allCases().end(), [&](const Case& c) { return c.name == name; });
}

class GlslParity : public testing::TestWithParam<std::size_t> {};

TEST_P(GlslParity, MatchesDouble) {
  const Case& c = allCases()[GetParam()];
  ASSERT_GE(c.sampleCount(), 65536u);
  const Comparison result = compare(c, runDouble(c), runGlsl(c, readShader), "GLSL");
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
  const auto radiance = runGlsl(c, readShader);
  EXPECT_EQ(countBad(radiance), 0u) << firstBad(c, radiance);
  EXPECT_GT(countLit(radiance), c.sampleCount());
}

// A test of the test: one constant 0.1 % off in the GLSL alone must be found.
TEST(GlslParityTest, FindsABrokenConstant) {
  const auto broken = [](const std::string& file, const std::string& right, const std::string& wrong) {
    return [=](const std::string& name) {
      std::optional<std::string> text = readShader(name);
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
