#include "precompute/report/visibility/visibility_report.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "assets/transfer/transfer.h"
#include "precompute/bake.h"
#include "precompute/report/prepared_scene.h"
#include "precompute/report/visibility/transfer_method.h"
#include "precompute/report/visibility/visibility_options.h"
#include "precompute/report/visibility/supplement_figures.h"
#include "precompute/report/visibility/visibility_page.h"
#include "precompute/report/visibility/visibility_study.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report visibility builtin:ornament
  chiaro-report visibility bunny.ply --ground -o signal
  chiaro-report visibility bunny.ply --bake 104 --bake 400
      joint bakes of so many bytes a vertex beside the others
  chiaro-report visibility builtin:ornament --figures -o signal
      with the supplement's figures 7 and 10; open signal/index.html
  chiaro-report visibility baked.glb --json signal.json
      the stored transfer beside the others

Bytes are those of weights, indices, means and bases together, divided by the vertices.
Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted.)";

struct Input {
  Scene scene;
  std::vector<Transfer> transfers;
};

/// Bakes `input` once for each number of bytes a vertex.
void bakeInto(Input& input, const VisibilityOptions& options, ProgressBar& bar) {
  for (const double bytes : options.bake) {
    BakeReport report;
    auto baked = bake(input.scene, {.bytesPerVertex = bytes, .seed = options.settings.seed, .threads = options.settings.threads}, report,
                      [&](const std::string& stage, double done) {
                        throwIfInterrupted();
                        bar.update("bake: " + stage, done);
                      });
    if (baked.scene.vertexCount() != input.scene.vertexCount()) throw std::logic_error("a prepared scene changed when it was baked");
    input.transfers.push_back(std::move(baked.transfer));
  }
}

Input load(const std::string& name, const VisibilityOptions& options) {
  if (isBakedFile(name)) {
    if (options.ground) throw usageError("--ground", name + " is baked already", "give the scene that it was baked from");
    if (!options.bake.empty()) throw usageError("--bake", name + " is baked already", "give the scene that it was baked from");
    auto baked = readBakedScene(name);
    Input input{.scene = std::move(baked.scene), .transfers = {}};
    input.transfers.push_back(std::move(baked.transfer));
    return input;
  }
  return {.scene = loadPreparedScene(name, options.ground), .transfers = {}};
}

SceneComparison compareScene(const std::string& name, const VisibilityOptions& options, ProgressBar& bar) {
  const auto start = std::chrono::steady_clock::now();
  Input input = load(name, options);
  const MethodMaker methods = [&](const VisibilityInput& from) {
    auto all = baselineMethods(from);
    for (std::size_t i = 0; i < input.transfers.size(); ++i)
      all.insert(all.begin() + static_cast<std::ptrdiff_t>(i), makeTransferMethod(input.transfers[i]));
    return all;
  };
  SceneComparison result;
  result.scene = name;
  result.ground = options.ground;
  namingScene(name, [&] {
    if (input.transfers.empty()) bakeInto(input, options, bar);
    const ProgressHandler progress = [&](const std::string& stage, double done) {
      throwIfInterrupted();
      bar.update(stage, done);
    };
    const VisibilityStudy study(input.scene, options.settings, progress);
    result.comparison = compareVisibility(study, methods, progress);
    if (options.figures) result.figures = supplementFigures(study, options.settings, progress);
  });
  bar.clear();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace

ExitCode visibilityReport(int argc, const char* const* argv) {
  CLI::App app(
      "Compares ways to store visibility with traced rays: the visible fraction of lobes, by sharpness, on counted bytes.",
      "chiaro-report visibility");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  VisibilityOptions options;
  declareVisibilityOptions(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishVisibilityOptions(options);
  catchInterrupts();

  ProgressBar bar(progressStyle(options.quiet));
  std::vector<SceneComparison> scenes;
  std::string tables;
  for (const auto& name : options.scenes) {
    scenes.push_back(compareScene(name, options, bar));
    const std::string table = visibilityTable(scenes.back());
    if (!options.quiet) std::printf("%s%s", tables.empty() ? "" : "\n", table.c_str());
    std::fflush(stdout);
    tables += (tables.empty() ? "" : "\n") + table;
  }
  const std::string json = visibilityJson(scenes, options.settings, CHIARO_VERSION);
  if (!options.output.empty()) {
    writeFileAtomically(options.output / "visibility.txt", tables);
    writeFileAtomically(options.output / "visibility.json", json);
    writeFileAtomically(options.output / "visibility.csv", visibilityCsv(scenes));
    if (options.figures) writeFileAtomically(options.output / "visibility_figures.csv", visibilityFiguresCsv(scenes));
    writeFileAtomically(options.output / "index.html", visibilityPage(scenes, options.settings, CHIARO_VERSION));
  }
  if (!options.json.empty()) writeFileAtomically(options.json, json);
  return ExitCode::done;
}

}  // namespace chiaro
