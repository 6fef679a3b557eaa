#include "precompute/report/upsampling/upsampling_report.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "assets/file.h"
#include "assets/image/image.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "precompute/report/upsampling/upsampling_options.h"
#include "precompute/report/upsampling/upsampling_tables.h"
#include "runtime/gl/context.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report upsampling baked.glb
      Blinn-Phong and GGX of ten widths, 60 frames of a turning camera
  chiaro-report upsampling baked.glb --moving knot -o upsampling --size 1920x1080
      a mesh of the scene turns too; pictures of the last frames and their total weights
  chiaro-report upsampling baked.glb --material blinnPhong=255 --material ggx=0.1 --frames 12

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted.)";

}  // namespace

ExitCode upsamplingReport(int argc, const char* const* argv) {
  CLI::App app("Measures upsampled frames against shading every pixel, over a moving camera and object.", "chiaro-report upsampling");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  UpsamplingOptions options;
  declareUpsamplingOptions(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishUpsamplingOptions(options);
  catchInterrupts();

  const BakedScene baked = readBakedScene(options.scene);
  gl::HeadlessContext context;
  ProgressBar bar(progressStyle(options.quiet));
  const StudyPicture save = [&](const std::string& material, const std::string& variant, const Image8& picture) {
    writePng(options.output / (material + "_" + variant + ".png"), picture);
  };
  const auto results = studyUpsampling(baked, options.settings, options.output.empty() ? StudyPicture() : save, [&](const std::string& stage, double done) {
    throwIfInterrupted();
    bar.update(stage, done);
  });
  bar.clear();
  context.debugLog().requireClean("the rendering");
  const std::string table = upsamplingTable(results);
  if (!options.quiet) std::printf("%s on %s\n", table.c_str(), context.renderer().c_str());
  const std::string json = upsamplingJson(results, options, context.renderer(), CHIARO_VERSION);
  if (!options.output.empty()) {
    writeFileAtomically(options.output / "upsampling.txt", table);
    writeFileAtomically(options.output / "upsampling.json", json);
  }
  if (!options.json.empty()) writeFileAtomically(options.json, json);
  return ExitCode::done;
}

}  // namespace chiaro
