#pragma once
/// `chiaro-report budget`.

#include "assets/error.h"

namespace chiaro {

/// arguments: those after `budget`, the first of them a name for the program. Throws Error.
ExitCode budgetReport(int argc, const char* const* argv);

}  // namespace chiaro
