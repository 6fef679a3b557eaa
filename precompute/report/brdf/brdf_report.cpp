#include "precompute/report/brdf/brdf_report.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "precompute/report/brdf/brdf_options.h"
#include "precompute/report/brdf/brdf_study.h"
#include "precompute/report/brdf/brdf_tables.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report brdf -o brdf
      every figure and the table of errors; open brdf/index.html
  chiaro-report brdf --quick
  chiaro-report brdf -o brdf --measured ../shared/data
      also all measured materials of a folder: fits, and their lobes against the data

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 5 an error is over its limit, 130 interrupted.)";

}  // namespace

ExitCode brdfReport(int argc, const char* const* argv) {
  CLI::App app("Measures reflectance models as spherical Gaussians, beside factorisation.", "chiaro-report brdf");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  BrdfOptions options;
  declareBrdfOptions(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishBrdfOptions(options);
  catchInterrupts();
  if (!options.warpChoice.empty()) {
    writeFileAtomically(options.warpChoice, warpChoiceText(options.threads));
    return ExitCode::done;
  }
  const auto files = measuredFiles(options.measured);
  ProgressBar bar(progressStyle(options.quiet));
  const auto progress = [&](const std::string& stage, double done) {
    throwIfInterrupted();
    bar.update(stage, done);
  };
  // What can be unreadable comes first.
  MeasuredStudy measured;
  if (!files.empty()) measured = studyMeasured(files, options.quick, options.threads, progress);
  BrdfStudy study = studyBrdfs(options.quick, options.threads, progress);
  study.figures.insert(study.figures.end(), measured.figures.begin(), measured.figures.end());
  study.measured = std::move(measured);
  bar.clear();
  const std::string json = brdfJson(study, CHIARO_VERSION);
  if (!options.output.empty()) {
    writeFileAtomically(options.output / "brdf.json", json);
    writeFileAtomically(options.output / "brdf.csv", brdfCsv(study));
    writeFileAtomically(options.output / "index.html", brdfPage(study, CHIARO_VERSION));
  }
  if (!options.json.empty()) writeFileAtomically(options.json, json);
  if (!options.quiet) std::printf("%s", brdfTable(study).c_str());
  for (const ModelError& e : study.models)
    if (!e.holds())
      throw Error(ExitCode::overTolerance, e.model, "an error of equation (11) is over its limit",
                  "see the rows marked in the table");
  return ExitCode::done;
}

}  // namespace chiaro
