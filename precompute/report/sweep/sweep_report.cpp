#include "precompute/report/sweep/sweep_report.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "precompute/journal/program_identity.h"
#include "precompute/report/prepared_scene.h"
#include "precompute/report/report_folder.h"
#include "precompute/report/sweep/sweep_options.h"
#include "precompute/report/sweep/sweep_page.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report sweep builtin:ornament -o sweep
      open sweep/index.html; the same command goes on where it was stopped
  chiaro-report sweep room.gltf -o sweep --bytes 36,104 --resolution 64 --no-baselines
  chiaro-report sweep bunny.ply --ground -o sweep --compression joint,clustered,pca

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted.)";

}  // namespace

ExitCode sweepReport(int argc, const char* const* argv) {
  CLI::App app("Bakes a scene with many settings and shows what each costs and buys, and which are worth having.", "chiaro-report sweep");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  SweepOptions options;
  declareSweepOptions(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishSweepOptions(options);
  if (isBakedFile(options.scene)) throw usageError("scene", options.scene + " is baked already", "give the scene that it was baked from");
  requireFolderCanBeMade(options.output);
  catchInterrupts();

  // The folder is made when there is something to put into it: a scene that cannot be read leaves nothing.
  SweepStudy study{.scene = options.scene, .ground = options.ground, .facts = {}, .measure = options.measure, .results = {}};
  const Scene scene = loadPreparedScene(options.scene, options.ground);
  if (scene.triangleCount() == 0) throw inputError(options.scene, "has no triangle with an area", "give a file with a surface in it");
  makeFolder(options.output);
  requireWritable(options.output / "index.html");
  SweepStore store(options.output / "sweep.jsonl", sweepKey(scene, options.measure, programIdentity("chiaro-report sweep " CHIARO_VERSION)));

  ProgressBar bar(progressStyle(options.quiet));
  const auto work = [&] {
    study.results = sweep(scene, pointsOf(options), options.measure, store, study.facts, [&](const std::string& stage, double done) {
      throwIfInterrupted();
      bar.update(stage, done);
    });
  };
  try {
    namingScene(options.scene, work);
  } catch (const Error& error) {
    if (error.code() != ExitCode::interrupted) throw;
    throw Error(ExitCode::interrupted, "interrupted", "the page is not written, what is finished is in " + (options.output / "sweep.jsonl").string(), "run the same command again to go on");
  }
  bar.clear();

  writeFileAtomically(options.output / "sweep.json", sweepJson(study, CHIARO_VERSION));
  writeFileAtomically(options.output / "sweep.csv", sweepCsv(study));
  writeFileAtomically(options.output / "index.html", sweepPage(study, CHIARO_VERSION));
  if (!options.quiet) std::printf("%s\nwrote %s\n", sweepTable(study).c_str(), (options.output / "index.html").c_str());
  return ExitCode::done;
}

}  // namespace chiaro
