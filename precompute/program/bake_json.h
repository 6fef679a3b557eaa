#pragma once
/// The `--json` of chiaro-precompute (docs/programs.md).

#include <string>

#include "precompute/bake.h"

namespace chiaro {

struct BakeRun {
  std::string input;
  std::string output;
  std::string version;
  BakeSettings settings;
  std::size_t peakMemoryBytes = 0;
  double loadSeconds = 0.0;
  double writeSeconds = 0.0;
  std::vector<std::string> warnings{};
  double memoryLimitMib = 0.0;  ///< 0: none
};

std::string bakeJson(const BakeRun& run, const BakeReport& report);

}  // namespace chiaro
