#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/program.h"
#include "assets/program/progress_bar.h"
#include "precompute/report/brdf/brdf_report.h"
#include "precompute/report/budget/budget_report.h"
#include "precompute/report/comparison.h"
#include "precompute/report/error_map.h"
#include "precompute/report/report_folder.h"
#include "precompute/report/report_options.h"
#include "precompute/report/report_page.h"
#include "precompute/report/report_tables.h"
#include "precompute/report/stability/stability_report.h"
#include "precompute/report/sweep/sweep_report.h"
#include "precompute/report/upsampling/upsampling_report.h"
#include "precompute/report/visibility/visibility_report.h"
#include "runtime/render/renderer.h"

namespace {

using namespace chiaro;

constexpr const char* kExamples = R"(Examples:
  chiaro-report baked.glb -o report
      under sunny, overcast and windows; open report/index.html
  chiaro-report baked.glb -o report -e sky.hdr -r 0.2 -r 0.4 -r 0.7 --samples 512
  chiaro-report baked.glb -o report --fail-under 30
      exit code 5 when a picture is further than that from the truth
  chiaro-report new.glb old.glb -o report --fail-over 0.005
      pictures of two bakes beside each other; exit code 5 when they differ by more
  chiaro-report visibility builtin:ornament
      ways to store visibility against traced rays; has options of its own, see chiaro-report visibility --help
  chiaro-report brdf -o brdf
      reflectance models as spherical Gaussians; see chiaro-report brdf --help
  chiaro-report sweep builtin:ornament -o sweep
      what each setting of a bake costs and buys; see chiaro-report sweep --help
  chiaro-report budget builtin:ornament -o budget
      which stage of a bake causes which error; see chiaro-report budget --help
  chiaro-report stability -o stability
      the shared functions in float and GLSL against double; see chiaro-report stability --help
  chiaro-report upsampling baked.glb
      upsampled frames against shading every pixel; see chiaro-report upsampling --help

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 5 under --fail-under or over --fail-over, 130 interrupted.)";

Image8 errorMapOf(const Comparison& one, ErrorMapKind kind) {
  if (kind == ErrorMapKind::flip) return flipErrorMap(one.perceptual.flipMap, one.reference);
  if (kind == ErrorMapKind::hdrFlip) return flipErrorMap(one.perceptual.hdrFlipMap, one.reference);
  return errorMap(one.runtime, one.reference, one.display);
}

std::vector<CasePictures> writePictures(const Comparisons& comparisons, const ReportOptions& options) {
  const std::filesystem::path& folder = options.output;
  std::vector<CasePictures> all;
  for (const Comparison& one : comparisons.cases) {
    CasePictures pictures;
    pictures.runtime = encodePng(displayImage(one.runtime, one.display.exposure, one.display.toneMap));
    pictures.reference = encodePng(displayImage(one.reference, one.display.exposure, one.display.toneMap));
    pictures.error = encodePng(errorMapOf(one, options.errorMap));
    writeFileAtomically(folder / (one.name + "_runtime.png"), pictures.runtime);
    writeFileAtomically(folder / (one.name + "_reference.png"), pictures.reference);
    writeFileAtomically(folder / (one.name + "_error.png"), pictures.error);
    all.push_back(std::move(pictures));
  }
  return all;
}

void printSummary(const Comparisons& comparisons, const std::filesystem::path& page) {
  for (const Comparison& one : comparisons.cases)
    std::printf("%-28s %6.2f dB (%.2f without the reference's noise)   rmse %.4f   bias %+.4f   noise %.4f\n", one.name.c_str(),
                one.difference.psnr, psnrOf(one.difference.rmseWithoutNoise), one.difference.rmse, one.difference.bias,
                one.difference.noise);
  std::printf("wrote %s\n", page.c_str());
}

Error overTolerance(const Comparison& one, const char* format, double value, double limit) {
  char what[96];
  std::snprintf(what, sizeof what, format, value, limit);
  return {ExitCode::overTolerance, one.name, what, "look at its error map"};
}

void judgePsnr(const Comparisons& comparisons, double limit) {
  for (const Comparison& one : comparisons.cases)
    if (!(one.difference.psnr >= limit)) throw overTolerance(one, "%.2f dB is under the limit of %.2f dB", one.difference.psnr, limit);
}

void judgeRmse(const Comparisons& comparisons, const ReportOptions& options) {
  for (const Comparison& one : comparisons.cases)
    if (const double error = judgedError(one, options); !(error <= *options.failOver)) throw overTolerance(one, "an RMSE of %.5f is over the limit of %.5f", error, *options.failOver);
}

/// Throws when a picture is not good enough. The report is on disk by then.
void judge(const Comparisons& comparisons, const ReportOptions& options) {
  for (const Comparison& one : comparisons.cases)
    if (one.difference.undefinedPixels > 0)
      throw Error(options.failUnder || options.failOver ? ExitCode::overTolerance : ExitCode::failed, one.name,
                  std::to_string(one.difference.undefinedPixels) + " pixels are not finite",
                  "look at its error map, they are magenta");
  if (options.failUnder) judgePsnr(comparisons, *options.failUnder);
  if (options.failOver) judgeRmse(comparisons, options);
}

ExitCode report(int argc, char** argv) {
  CLI::App app("Compares what the runtime draws with brute-force ray tracing, picture by picture.", "chiaro-report");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-report " CHIARO_VERSION);
  ReportOptions options;
  ReportOptionTexts texts;
  declareReportOptions(app, options, texts);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  finishReportOptions(options, texts);
  catchInterrupts();

  BakedScene baked = readBakedScene(options.scene);
  baked.scene.lights.insert(baked.scene.lights.end(), options.lights.begin(), options.lights.end());
  if (const std::string left = leftOut(baked.scene); !left.empty() && !options.quiet)
    std::fprintf(stderr, "chiaro-report: warning: %s: %s, in the reference all of them\n", options.scene.c_str(), left.c_str());
  std::optional<BakedScene> other;
  if (!options.other.empty()) {
    other = readBakedScene(options.other);
    other->scene.lights.insert(other->scene.lights.end(), options.lights.begin(), options.lights.end());
  }
  ProgressBar bar(progressStyle(options.quiet));
  const Comparisons comparisons = compareAll(baked, other ? &*other : nullptr, options, [&](const std::string& stage, double done) {
    throwIfInterrupted();
    bar.update(stage, done);
  });
  bar.clear();

  ReportFacts facts = factsOf(baked, options);
  facts.version = CHIARO_VERSION;
  makeFolder(options.output);
  const std::vector<CasePictures> pictures = writePictures(comparisons, options);
  writeFileAtomically(options.output / "report.json", reportJson(facts, options, comparisons));
  writeFileAtomically(options.output / "report.csv", reportCsv(comparisons));
  writeFileAtomically(options.output / "index.html", reportPage(facts, options, comparisons, pictures));
  if (!options.quiet) printSummary(comparisons, options.output / "index.html");
  judge(comparisons, options);
  return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
  return chiaro::runMain("chiaro-report", [&] {
    if (argc > 1 && std::string_view(argv[1]) == "visibility") return chiaro::visibilityReport(argc - 1, argv + 1);
    if (argc > 1 && std::string_view(argv[1]) == "upsampling") return chiaro::upsamplingReport(argc - 1, argv + 1);
    if (argc > 1 && std::string_view(argv[1]) == "brdf") return chiaro::brdfReport(argc - 1, argv + 1);
    if (argc > 1 && std::string_view(argv[1]) == "sweep") return chiaro::sweepReport(argc - 1, argv + 1);
    if (argc > 1 && std::string_view(argv[1]) == "stability") return chiaro::stabilityReport(argc - 1, argv + 1);
    if (argc > 1 && std::string_view(argv[1]) == "budget") return chiaro::budgetReport(argc - 1, argv + 1);
    return report(argc, argv);
  });
}
