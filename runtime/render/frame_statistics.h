#pragma once
/// What a run of frames cost, pass by pass.

#include <string>
#include <vector>

#include "runtime/render/renderer.h"

namespace chiaro {

struct PassStatistics {
  std::string name;
  double minimum = 0.0;  ///< GPU milliseconds
  double median = 0.0;   ///< of an even count, the mean of the two in the middle
  double maximum = 0.0;
};

/// One entry a pass, in the order in which they first appear. A pass missing from some frames counts where it is.
std::vector<PassStatistics> passStatistics(const std::vector<FrameTimings>& frames);

}  // namespace chiaro
