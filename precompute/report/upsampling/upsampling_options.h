#pragma once
/// What `chiaro-report upsampling` was asked to do.

#include <filesystem>
#include <string>
#include <vector>

#include "precompute/report/upsampling/upsampling_study.h"

namespace CLI {
class App;
}

namespace chiaro {

struct UpsamplingOptions {
  std::filesystem::path scene;   ///< a baked .glb
  std::filesystem::path output;  ///< a folder, made where missing; empty: none
  std::filesystem::path json;    ///< empty: none
  UpsamplingSettings settings;
  bool quiet = false;

  std::vector<std::string> materials, variants;  ///< as given
  std::string size = "480x270", camera = "auto", recompute = "10%";
};

/// Declares every option on `app`; `options` must outlive its parse().
void declareUpsamplingOptions(CLI::App& app, UpsamplingOptions& options);

/// Checks and converts what parse() left, and makes the output folder. Throws Error (usage, unreadableInput, unwritableOutput).
void finishUpsamplingOptions(UpsamplingOptions& options);

}  // namespace chiaro
