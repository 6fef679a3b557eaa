#pragma once
/// `chiaro-report upsampling`.

#include "assets/error.h"

namespace chiaro {

/// arguments: those after `upsampling`, the first of them a name for the program. Throws Error.
ExitCode upsamplingReport(int argc, const char* const* argv);

}  // namespace chiaro
