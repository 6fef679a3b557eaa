#pragma once
#include "assets/error.h"

namespace chiaro {

/// `chiaro-report brdf ...`; argv[0] is "brdf". Throws Error.
ExitCode brdfReport(int argc, const char* const* argv);

}  // namespace chiaro
