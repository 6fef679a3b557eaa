#include "precompute/report/stability/stability_report.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "precompute/report/report_folder.h"
#include "precompute/report/stability/stability.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report stability -o stability
  chiaro-report stability --no-gl --json stability.json

Exit codes: 0 done, 1 failed (no OpenGL 4.5: give --no-gl), 2 wrong usage, 4 unwritable output, 5 over tolerance, 130 interrupted.)";

/// Throws where a function is over its tolerance. The report is on disk by then.
void judge(const StabilityStudy& study) {
  for (const auto& one : study.functions)
    if (one.cpp.failures > 0 || (one.glsl && one.glsl->failures > 0))
      throw Error(ExitCode::overTolerance, one.name, "is over its tolerance in " + std::string(one.cpp.failures > 0 ? "float C++" : "GLSL"), "look at its worst inputs in the JSON");
}

}  // namespace

ExitCode stabilityReport(int argc, const char* const* argv) {
  CLI::App app("Every function that shaders and C++ share, in float and GLSL against double, over its whole domain.", "chiaro-report stability");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  std::filesystem::path output, json;
  bool noGl = false, quiet = false;
  app.add_option("-o,--output", output, "Folder for index.html and stability.json")->type_name("DIR");
  app.add_option("--json", json, "Write the figures here")->type_name("FILE");
  app.add_flag("--no-gl", noGl, "Leave out GLSL: needs no OpenGL");
  app.add_flag("-q,--quiet", quiet, "Print nothing but errors");
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  if (!output.empty()) requireFolderCanBeMade(output);
  if (!json.empty()) requireWritable(json);
  catchInterrupts();

  ProgressBar bar(progressStyle(quiet));
  const auto study = stabilityStudy(!noGl, [&](const std::string& stage, double done) {
    throwIfInterrupted();
    bar.update(stage, done);
  });
  bar.clear();
  if (!output.empty()) {
    makeFolder(output);
    writeFileAtomically(output / "stability.json", stabilityJson(study, CHIARO_VERSION));
    writeFileAtomically(output / "index.html", stabilityPage(study, CHIARO_VERSION));
  }
  if (!json.empty()) writeFileAtomically(json, stabilityJson(study, CHIARO_VERSION));
  if (!quiet) std::printf("%s", stabilityTable(study).c_str());
  judge(study);
  return ExitCode::done;
}

}  // namespace chiaro
