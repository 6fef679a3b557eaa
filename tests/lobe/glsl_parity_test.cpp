/// GLSL on this machine's driver against double C++ over every function and the whole stated domain: did the compiler, the driver or
/// our dialect change anything?

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>

#include "runtime/gl/buffer.h"
#include "runtime/gl/program.h"
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

// A million models at their ends, in directions at the ends of theirs: light is finite and never negative.
TEST(GlslExtremes, ModelsAreFiniteAndNeverNegative) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> gauss;
  Case c = caseNamed("reflectanceTimesCosine");
  c.inputs.clear();
  const auto direction = [&] {
    glm::dvec3 d(gauss(engine), gauss(engine), gauss(engine));
    const double kind = unit(engine);
    if (kind < .3) d.z *= std::pow(10.0, -8 * unit(engine));
    else if (kind < .5) d = glm::dvec3(d.x * 1e-4, d.y * 1e-4, 1);
    return glm::vec3(glm::normalize(d));
  };
  for (int i = 0; i < 1'000'000; ++i) {
    const int kind = i % lobe64::kModelCount;
    c.inputs.push_back(static_cast<float>(kind));
    for (int k = 0; k < 2; ++k) {
      const double u = unit(engine) < .3 ? std::round(unit(engine)) : unit(engine);
      c.inputs.push_back(static_cast<float>(lobe64::modelHasExponent(kind) ? std::pow(10.0, 6 * u) : std::pow(10.0, -4 * u)));
    }
    const glm::vec3 wo = direction(), wi = unit(engine) < .5 ? glm::vec3(-wo.x, -wo.y, wo.z) : direction();
    c.inputs.insert(c.inputs.end(), {wo.x, wo.y, wo.z, wi.x, wi.y, wi.z, std::round(static_cast<float>(unit(engine)))});
  }
  std::size_t bad = 0, lit = 0;
  for (const float value : runGlsl(c, readShader)) {
    bad += !(std::isfinite(value) && value >= 0.0f);
    lit += value > 0.0f;
  }
  EXPECT_EQ(bad, 0u);
  EXPECT_GT(lit, 400'000u);
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
