#pragma once
/// `chiaro-report sweep`.

#include "assets/error.h"

namespace chiaro {

/// arguments: those after `sweep`, the first of them a name for the program. Throws Error.
ExitCode sweepReport(int argc, const char* const* argv);

}  // namespace chiaro
