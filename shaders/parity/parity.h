#pragma once
/// The same kernel, three times: float C++ and float GLSL against double C++, over tens of thousands of float inputs.

#include <functional>
#include <string>
#include <vector>

#include "shaders/cpp/lobe.h"

#include "shaders/cpp/dialect_begin.h"
namespace chiaro::lobe32 {
#include "shaders/parity/kernels.glsl"
#undef KERNEL
}  // namespace chiaro::lobe32
namespace chiaro::lobe64 {
#include "shaders/parity/kernels.glsl"
#undef KERNEL
}  // namespace chiaro::lobe64
#include "shaders/cpp/dialect_end.h"

namespace chiaro::parity {

inline constexpr double kTolerance = 1e-5;  ///< relative, the promise of the lobe library
inline constexpr double kFloor = 1e-7;      ///< errors are relative to max(|expected|, kFloor * scale)

/// Outputs [first, first + size) compared as one vector by its length (size 1: a scalar).
struct Group {
  int first = 0;
  int size = 1;
};

/// What the floor is measured against for one input: 1 for functions whose natural size is 1, the product of the amplitudes for
/// lobes, which scale with them.
using Scale = std::function<double(const float* in)>;

struct Case {
  std::string name;
  int inputCount = 0;
  int outputCount = 0;
  std::vector<Group> groups;
  void (*run32)(const lobe32::KernelInput&, float (&)[25]) = nullptr;
  void (*run64)(const lobe64::KernelInput&, double (&)[25]) = nullptr;
  std::vector<float> inputs;  ///< inputCount floats per sample
  Scale scale;
  std::string domain;         ///< in words, for the table
  double tolerance = kTolerance;  ///< above kTolerance only where `domain` says why

  std::size_t sampleCount() const { return inputs.size() / static_cast<std::size_t>(inputCount); }
};

/// Every function of shaders/lobe. Deterministic.
const std::vector<Case>& allCases();

/// outputCount values per sample.
std::vector<double> runDouble(const Case& c);
std::vector<float> runFloat(const Case& c);

struct Comparison {
  std::size_t samples = 0, failures = 0;
  double worst = 0.0, median = 0.0, percentile99 = 0.0;  ///< relative error over the floor, over finite expectations
  std::size_t worstSample = 0;
  int worstOutput = 0;               ///< first of its group
  double worstUlps = 0.0;            ///< the same error in steps of a float of the expected size (or of the floor)
  std::size_t classFailures = 0;     ///< NaN or infinity on one side only
  std::size_t firstClassFailure = 0;
  std::string report;                ///< one line, and the worst case when something failed
};

/// `got` against `expected`, sample by sample. Where an input is NaN and so is the expectation, the answer must
/// be NaN; where the expectation is otherwise not finite (or beyond float), the answer must not be finite either.
Comparison compare(const Case& c, const std::vector<double>& expected, const std::vector<float>& got, const std::string& label);

}  // namespace chiaro::parity
