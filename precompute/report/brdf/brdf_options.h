#pragma once
/// What `chiaro-report brdf` was asked to do.

#include <filesystem>
#include <vector>

namespace CLI {
class App;
}

namespace chiaro {

struct BrdfOptions {
  std::filesystem::path output;      ///< a folder, made where missing; empty: none
  std::filesystem::path json;        ///< empty: none
  std::filesystem::path warpChoice;  ///< write the table of warps here and measure nothing else; empty: no
  std::vector<std::filesystem::path> measured;  ///< files and folders of measured materials; empty: none
  int threads = 0;
  bool quick = false;
  bool quiet = false;
};

/// Declares every option on `app`; `options` must outlive its parse().
void declareBrdfOptions(CLI::App& app, BrdfOptions& options);

/// Checks what parse() left, and makes the output folder. Throws Error (usage, unwritableOutput).
void finishBrdfOptions(const BrdfOptions& options);

}  // namespace chiaro
