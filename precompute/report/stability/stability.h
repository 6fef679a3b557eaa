#pragma once
/// How stable the shared maths is: every function of shaders/lobe in float C++ and in GLSL against double C++.

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace chiaro {

/// Of one function on one machine, over all its inputs.
struct StabilityFigures {
  double median = 0.0, percentile99 = 0.0, worst = 0.0;  ///< relative errors, over the floor of shaders/parity/parity.h
  double worstUlps = 0.0;                                ///< the worst in steps of a float of that size
  std::vector<float> worstInputs;
  std::size_t failures = 0;       ///< samples over the tolerance, or NaN or infinite on one side only
};

struct FunctionStability {
  std::string name, domain;
  std::size_t samples = 0;
  double tolerance = 0.0;
  StabilityFigures cpp;
  std::optional<StabilityFigures> glsl;  ///< absent without OpenGL
};

struct StabilityStudy {
  std::string renderer;  ///< of OpenGL; empty: none
  std::vector<FunctionStability> functions;
};

/// gl: with GLSL too, on a headless context; throws Error where there is none. progress: stage, share done.
StabilityStudy stabilityStudy(bool gl, const std::function<void(const std::string&, double)>& progress);

std::string stabilityTable(const StabilityStudy& study);
/// Field names: docs/programs.md.
std::string stabilityJson(const StabilityStudy& study, const std::string& version);
std::string stabilityPage(const StabilityStudy& study, const std::string& version);

}  // namespace chiaro
