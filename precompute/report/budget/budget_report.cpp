#include "precompute/report/budget/budget_report.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "precompute/report/budget/budget_tables.h"
#include "precompute/report/prepared_scene.h"
#include "precompute/report/report_folder.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report budget builtin:ornament -o budget
  chiaro-report budget room.gltf -o budget --bytes 300

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted.)";

struct BudgetOptions {
  std::string scene;
  std::filesystem::path output;
  bool ground = false;
  BakeSettings settings;
  VisibilitySettings measure{.vertices = 250, .points = 250, .rays = 2048};
  bool quiet = false;
};

void declareOptions(CLI::App& app, BudgetOptions& options) {
  const auto shown = [](CLI::Option* option) { option->type_name("N")->capture_default_str(); };
  app.add_option("scene", options.scene, "Scene file that is not baked, or builtin:NAME")->required()->type_name("SCENE");
  app.add_option("-o,--output", options.output, "Folder for index.html, budget.json and budget.csv")->required()->type_name("DIR");
  shown(app.add_option("--resolution", options.settings.resolution, "Texels a side of the octahedral sphere, 16 to 128, a multiple of 8"));
  shown(app.add_option("--terms", options.settings.terms, "Weights a lookup fetches at most, 0 as a bake chooses"));
  shown(app.add_option("--bytes", options.settings.bytesPerVertex, "Bytes a vertex that rounding has to fit, 0 as a bake chooses"));
  app.add_flag("--ground", options.ground, "Put a square of 1600 vertices, three diagonals wide, under the scene");
  shown(app.add_option("--vertices", options.measure.vertices, "Random vertices to measure at"));
  shown(app.add_option("--points-inside", options.measure.points, "Random points inside triangles to measure at"));
  shown(app.add_option("--rays", options.measure.rays, "Rays of the truth, a lobe"));
  shown(app.add_option("--seed", options.measure.seed, "Of the random choices"));
  shown(app.add_option("--threads", options.measure.threads, "CPU threads, 0 is all; never changes the figures"));
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void requireRange(const char* option, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw usageError(option, "is out of range", "give a value from " + std::to_string(least) + " to " + std::to_string(most));
}

void finishOptions(BudgetOptions& options) {
  const auto& measure = options.measure;
  requireRange("--vertices", measure.vertices, 1, 1 << 20);
  requireRange("--points-inside", measure.points, 0, 1 << 20);
  requireRange("--rays", measure.rays, 32, 1 << 20);
  requireRange("--threads", measure.threads, 0, 1024);
  requireRange("--resolution", options.settings.resolution, 16, 128);
  requireRange("--terms", options.settings.terms, 0, 256);
  options.settings.seed = measure.seed;
  options.settings.threads = measure.threads;
  options.settings = resolvedSettings(options.settings);
}

}  // namespace

ExitCode budgetReport(int argc, const char* const* argv) {
  CLI::App app("Replaces one stage of a bake after another by its exact form, and says what each causes of the error.", "chiaro-report budget");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  BudgetOptions options;
  declareOptions(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishOptions(options);
  if (isBakedFile(options.scene)) throw usageError("scene", options.scene + " is baked already", "give the scene that it was baked from");
  requireFolderCanBeMade(options.output);
  catchInterrupts();

  ProgressBar bar(progressStyle(options.quiet));
  BudgetStudy study{.scene = options.scene, .ground = options.ground, .measure = options.measure, .budget = {}};
  namingScene(options.scene, [&] {
    const Scene scene = loadPreparedScene(options.scene, options.ground);
    study.budget = errorBudget(scene, options.settings, options.measure, [&](const std::string& stage, double done) {
      throwIfInterrupted();
      bar.update(stage, done);
    });
  });
  bar.clear();

  makeFolder(options.output);
  writeFileAtomically(options.output / "budget.json", budgetJson(study, CHIARO_VERSION));
  writeFileAtomically(options.output / "budget.csv", budgetCsv(study));
  writeFileAtomically(options.output / "index.html", budgetPage(study, CHIARO_VERSION));
  if (!options.quiet) std::printf("%s\nwrote %s\n", budgetTable(study).c_str(), (options.output / "index.html").c_str());
  return ExitCode::done;
}

}  // namespace chiaro
