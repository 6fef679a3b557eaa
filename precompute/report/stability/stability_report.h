#pragma once
/// `chiaro-report stability`.

#include "assets/error.h"

namespace chiaro {

/// arguments: those after `stability`, the first of them a name for the program. Throws Error.
ExitCode stabilityReport(int argc, const char* const* argv);

}  // namespace chiaro
