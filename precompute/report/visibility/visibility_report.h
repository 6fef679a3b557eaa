#pragma once
/// `chiaro-report visibility`.

#include "assets/error.h"

namespace chiaro {

/// arguments: those after `visibility`, the first of them a name for the program. Throws Error.
ExitCode visibilityReport(int argc, const char* const* argv);

}  // namespace chiaro
