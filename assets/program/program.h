#pragma once
/// What the programs share: one way to fail, the exit codes of assets/error.h.

#include <functional>
#include <string>

#include "assets/error.h"

namespace chiaro {

/// Runs `body` and returns the process's exit code. An Error is printed as `program: where: what: remedy` on standard error and
/// gives its own code; running out of memory or any other exception is printed the same way and gives 1.
int runMain(const std::string& program, const std::function<ExitCode()>& body);

}  // namespace chiaro
