#pragma once
#include "assets/error.h"

namespace chiaro {

/// `chiaro-precompute material ...`; argv[0] is "material". Throws Error.
ExitCode materialProgram(int argc, const char* const* argv);

}  // namespace chiaro
