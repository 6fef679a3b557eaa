#include "precompute/report/brdf/brdf_options.h"

#include <CLI/CLI.hpp>

#include "assets/error.h"
#include "assets/file.h"

namespace chiaro {

void declareBrdfOptions(CLI::App& app, BrdfOptions& options) {
  app.add_option("-o,--output", options.output, "Folder for index.html, brdf.json and brdf.csv")->type_name("DIR");
  app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
  app.add_flag("--quick", options.quick, "Fewer parameters and coarser grids, for a look in seconds");
  app.add_option("--measured", options.measured, "Also fit the measured materials of this file or folder; may be repeated")
      ->type_name("PATH");
  app.add_option("--warp-choice", options.warpChoice,
                 "Measure which warp is best where, write it as shaders/lobe/warp_choice.glsl, and nothing else")
      ->type_name("FILE");
  app.add_option("--threads", options.threads, "CPU threads, 0 is all; never changes the figures")
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishBrdfOptions(const BrdfOptions& options) {
  if (options.threads < 0 || options.threads > 1024)
    throw usageError("--threads", "must lie between 0 and 1024", "give 0 for all cores");
  if (!options.output.empty()) {
    std::error_code failure;
    std::filesystem::create_directories(options.output, failure);
    if (failure)
      throw outputError(options.output.string(), "the folder cannot be made: " + failure.message(), "give another one with -o");
    requireWritable(options.output / "brdf.json");
  }
  if (!options.json.empty()) requireWritable(options.json);
  if (!options.warpChoice.empty()) requireWritable(options.warpChoice);
}

}  // namespace chiaro
