#include "precompute/report/sweep/sweep_report.h"

#include <signal.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

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
  chiaro-report sweep bunny.ply --ground -o sweep --compression joint,clustered,pca --jobs 0
  chiaro-report sweep room.gltf -o sweep --lobes 0,3,1 --prefilter 512,128 --target-frame-time 20
      the least picture error among the settings that draw a frame in 20 ms here

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 5 no setting within the targets, 130 interrupted.)";

constexpr const char* kBakesFolder = "baked";

std::string keyOf(const Scene& scene, const SweepOptions& options) { return sweepKey(scene, options.measure, programIdentity("chiaro-report sweep " CHIARO_VERSION)); }

/// What a process of bakeInParallel() does.
ExitCode bakeOne(SweepOptions options) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // without the sweep there is nobody to measure it
  catchInterrupts();
  const auto points = pointsOf(options);
  const Scene scene = loadPreparedScene(options.scene, options.ground);
  const auto key = keyOf(scene, options);
  options.measure.threads = options.bakeThreads;
  namingScene(options.scene, [&] {
    SweepBakes(scene, options.measure, options.output / kBakesFolder, key).store(points.at(static_cast<std::size_t>(options.bakePoint)), [](const std::string&, double) { throwIfInterrupted(); });
  });
  return ExitCode::done;
}

}  // namespace

ExitCode sweepReport(int argc, const char* const* argv) {
  CLI::App app("Bakes a scene with many settings and shows what each costs and buys, and which are worth having.", "chiaro-report sweep");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  SweepOptions options;
  SweepOptionTexts texts;
  declareSweepOptions(app, options, texts);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishSweepOptions(options, texts);
  if (options.bakePoint >= 0) return bakeOne(options);
  if (isBakedFile(options.scene)) throw usageError("scene", options.scene + " is baked already", "give the scene that it was baked from");
  requireFolderCanBeMade(options.output);
  catchInterrupts();

  // The folder is made when there is something to put into it: a scene that cannot be read leaves nothing.
  SweepStudy study{.scene = options.scene, .ground = options.ground, .facts = {}, .measure = options.measure, .drawn = options.pictures, .targetError = options.targetError, .targetFrameTime = options.targetFrameTime, .results = {}};
  const Scene scene = loadPreparedScene(options.scene, options.ground);
  if (scene.triangleCount() == 0) throw inputError(options.scene, "has no triangle with an area", "give a file with a surface in it");
  makeFolder(options.output);
  requireWritable(options.output / "index.html");
  const auto key = keyOf(scene, options);
  std::optional<SweepPictures> pictures;
  if (!options.noFrames) {
    pictures.emplace(scene, options.pictures);
    study.glRenderer = pictures->glRenderer();
  }
  SweepStore store(options.output / "sweep.jsonl", pictures ? key + ", " + pictures->key() : key);
  SweepBakes bakes(scene, options.measure, options.output / kBakesFolder, key);

  ProgressBar bar(progressStyle(options.quiet));
  const auto points = pointsOf(options);
  const ProgressHandler progress = [&](const std::string& stage, double done) {
    throwIfInterrupted();
    bar.update(stage, done);
  };
  const auto work = [&] {
    const int jobs = options.jobs > 0 ? options.jobs : jobsThatFit(points, scene.vertexCount(), options.measure.threads);
    if (jobs > 1) {
      std::vector<std::size_t> wanted;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].isBake() && !store.find(points[i])) wanted.push_back(i);
      std::vector<std::string> arguments{"chiaro-report"};
      arguments.insert(arguments.end(), argv, argv + argc);
      bakeInParallel(bakes, points, wanted, jobs, options.measure.threads, arguments, progress);
    }
    study.results = sweep(scene, points, options.measure, store, bakes, pictures ? &*pictures : nullptr, study.facts, progress);
    study.chosen = choose(study.results, options.targetError, options.targetFrameTime);
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
  if (!study.targets()) return ExitCode::done;
  if (!study.chosen) throw Error(ExitCode::overTolerance, options.scene, "no setting of the sweep is within the targets", "allow more, or sweep more settings");
  if (!options.quiet) std::printf("within the targets: %s\n%s\n", labelOf(points[*study.chosen]).c_str(), commandsOf(points[*study.chosen], options.scene).c_str());
  return ExitCode::done;
}

}  // namespace chiaro
