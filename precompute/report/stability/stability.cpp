#include "precompute/report/stability/stability.h"

#include "runtime/gl/context.h"
#include "runtime/parity/run_glsl.h"

namespace chiaro {
namespace {

StabilityFigures figuresOf(const parity::Case& c, const std::vector<double>& expected, const std::vector<float>& got, const std::string& label) {
  const auto result = parity::compare(c, expected, got, label);
  const auto count = static_cast<std::size_t>(c.inputCount);
  const auto first = c.inputs.begin() + static_cast<std::ptrdiff_t>(result.worstSample * count);
  return {.median = result.median,
          .percentile99 = result.percentile99,
          .worst = result.worst,
          .worstUlps = result.worstUlps,
          .worstInputs = {first, first + static_cast<std::ptrdiff_t>(count)},
          .failures = result.failures};
}

}  // namespace

StabilityStudy stabilityStudy(bool gl, const std::function<void(const std::string&, double)>& progress) {
  StabilityStudy study;
  std::optional<gl::HeadlessContext> context;
  if (gl) study.renderer = context.emplace().renderer();
  const auto& cases = parity::allCases();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& c = cases[i];
    if (progress) progress("functions", static_cast<double>(i) / static_cast<double>(cases.size()));
    const auto expected = parity::runDouble(c);
    FunctionStability one{.name = c.name, .domain = c.domain, .samples = c.sampleCount(), .tolerance = c.tolerance, .cpp = figuresOf(c, expected, parity::runFloat(c), "float C++"), .glsl = {}};
    if (context) one.glsl = figuresOf(c, expected, parity::runGlsl(c, gl::readEmbeddedShader), "GLSL");
    study.functions.push_back(std::move(one));
  }
  if (context) context->debugLog().requireClean("the functions");
  return study;
}

}  // namespace chiaro
