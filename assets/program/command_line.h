#pragma once
/// How every program takes its command line; for those that link CLI11.

#include <CLI/CLI.hpp>
#include <iostream>

#include "assets/error.h"

namespace chiaro {

/// Reads the options that `app`, which has a name, declares. False when all is said: --help, --version. Throws Error (usage).
inline bool readCommandLine(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    app.exit(asked, std::cout, std::cerr);
    return false;
  } catch (const CLI::ParseError& error) {
    throw usageError("command line", error.what(), "see " + app.get_name() + " --help");
  }
  return true;
}

}  // namespace chiaro
