#pragma once
/// What `chiaro-report visibility` was asked to do.

#include <filesystem>
#include <string>
#include <vector>

#include "precompute/report/visibility/visibility_comparison.h"

namespace CLI {
class App;
}

namespace chiaro {

struct VisibilityOptions {
  std::vector<std::string> scenes;  ///< files or builtin: names
  std::filesystem::path output;     ///< a folder, made where missing; empty: none
  std::filesystem::path json;       ///< empty: none
  VisibilitySettings settings;
  std::vector<double> bake;         ///< bytes a vertex, one bake each
  bool ground = false;
  bool figures = false;             ///< supplementFigures() too
  bool quiet = false;
};

/// Declares every option on `app`; `options` must outlive its parse().
void declareVisibilityOptions(CLI::App& app, VisibilityOptions& options);

/// Checks what parse() left, and makes the output folder. Throws Error (usage, unwritableOutput).
void finishVisibilityOptions(const VisibilityOptions& options);

}  // namespace chiaro
