#include "precompute/report/budget/budget_report.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "assets/builtin/environment.h"
#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/progress_bar.h"
#include "precompute/report/budget/budget_tables.h"
#include "precompute/report/budget/image_tables.h"
#include "precompute/report/prepared_scene.h"
#include "precompute/report/report_folder.h"
#include "precompute/report/report_options.h"
#include "runtime/render/upsample_spec.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-report budget builtin:ornament -o budget
  chiaro-report budget room.gltf -o budget --bytes 300
  chiaro-report budget bunny.ply --ground -o budget -e windows -r 0.3 --metallic 1
      the pictures' part in another light and material; --no-pictures leaves it out and needs no OpenGL

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted.)";

struct BudgetOptions {
  std::string scene;
  std::filesystem::path output;
  bool ground = false;
  BakeSettings settings;
  VisibilitySettings measure{.vertices = 250, .points = 250, .rays = 2048};
  ImageBudgetSettings pictures;
  std::string size = "96x72", camera = "auto";
  bool noPictures = false, noMesh = false;
  bool quiet = false;
};

void declareOptions(CLI::App& app, BudgetOptions& options) {
  const auto shown = [](CLI::Option* option) { option->type_name("N")->capture_default_str(); };
  app.add_option("scene", options.scene, "Scene file that is not baked, or builtin:NAME")->required()->type_name("SCENE");
  app.add_option("-o,--output", options.output, "Folder for index.html, budget.json, budget.csv, budget_pictures.csv and error.glb")->required()->type_name("DIR");
  shown(app.add_option("--resolution", options.settings.resolution, "Texels a side of the octahedral sphere, 16 to 128, a multiple of 8"));
  shown(app.add_option("--terms", options.settings.terms, "Weights a lookup fetches at most, 0 as a bake chooses"));
  shown(app.add_option("--bytes", options.settings.bytesPerVertex, "Bytes a vertex that rounding has to fit, 0 as a bake chooses"));
  app.add_flag("--ground", options.ground, "Put a square of 1600 vertices, three diagonals wide, under the scene");
  shown(app.add_option("--vertices", options.measure.vertices, "Random vertices to measure at"));
  shown(app.add_option("--points-inside", options.measure.points, "Random points inside triangles to measure at"));
  shown(app.add_option("--rays", options.measure.rays, "Rays of the truth, a lobe"));
  app.add_option("-e,--environment", options.pictures.environment, "Light of the pictures: a built-in name, or an .hdr or .exr file")->type_name("NAME|FILE")->capture_default_str();
  app.add_option("-r,--roughness", options.pictures.materials.roughness, "Perceptual roughness of every material in the pictures, 0 to 1")->type_name("R");
  app.add_option("--metallic", options.pictures.materials.metallic, "Metalness of every material in the pictures, 0 to 1")->type_name("M");
  app.add_option("--size", options.size, "Picture size in pixels")->type_name("WxH")->capture_default_str();
  app.add_option("--camera", options.camera, "auto, an index or name of a camera in the file, or eye=X,Y,Z,target=X,Y,Z,fov-deg=D")->type_name("SPEC")->capture_default_str();
  shown(app.add_option("--samples", options.pictures.samples, "Sample pairs a pixel of the reference and of exact light, an even number"));
  shown(app.add_option("--rays-per-lobe", options.pictures.raysPerLobe, "Of every lobe whose visible share a pixel asks for"));
  shown(app.add_option("--upsample", options.pictures.upsample, "Draw the pictures so, 1 to 4: upsampling is a cause of its own"));
  app.add_flag("--no-mesh", options.noMesh, "Leave out the error at every vertex and error.glb");
  app.add_flag("--no-pictures", options.noPictures, "Leave the pictures out: needs no OpenGL");
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
  auto& pictures = options.pictures;
  requireRange("--samples", pictures.samples, 8, 1 << 16);
  if (pictures.samples % 2 != 0) throw usageError("--samples", "is not even", "give a number such as 512");
  requireRange("--rays-per-lobe", pictures.raysPerLobe, 1, 1 << 16);
  for (const auto& [option, value] : {std::pair{"--roughness", pictures.materials.roughness}, std::pair{"--metallic", pictures.materials.metallic}})
    if (value && !(*value >= 0.0f && *value <= 1.0f)) throw usageError(option, "must lie between 0 and 1", "give a number such as 0.4");
  requireUpsample(pictures.upsample, "--upsample");
  pictures.size = sizeFrom(options.size);
  pictures.camera = parseCameraSpec(options.camera);
  pictures.seed = measure.seed;
  pictures.threads = measure.threads;
  requireEnvironment(pictures.environment);
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
  BudgetStudy study{.scene = options.scene, .ground = options.ground, .measure = options.measure, .budget = {}, .drawn = options.pictures, .pictures = {}, .view = {}};
  std::vector<std::uint8_t> mesh;
  namingScene(options.scene, [&] {
    const Scene scene = loadPreparedScene(options.scene, options.ground);
    const ProgressHandler progress = [&](const std::string& stage, double done) {
      throwIfInterrupted();
      bar.update(stage, done);
    };
    BakedScene baked;
    study.budget = errorBudget(scene, options.settings, options.measure, baked, progress);
    if (!options.noMesh) {
      study.view = viewErrors(scene, vertexErrors(scene, baked.transfer, {.seed = options.measure.seed, .threads = options.measure.threads}, progress), options.pictures.camera);
      mesh = errorMesh(scene, study.view->errors, "chiaro-report " CHIARO_VERSION);
    }
    if (!options.noPictures) study.pictures = imageBudget(baked, options.pictures, progress);
  });
  bar.clear();

  makeFolder(options.output);
  writeFileAtomically(options.output / "budget.json", budgetJson(study, CHIARO_VERSION));
  writeFileAtomically(options.output / "budget.csv", budgetCsv(study));
  if (!mesh.empty()) writeFileAtomically(options.output / "error.glb", mesh);
  if (study.pictures) writeFileAtomically(options.output / "budget_pictures.csv", imageBudgetCsv(*study.pictures));
  writeFileAtomically(options.output / "index.html", budgetPage(study, CHIARO_VERSION));
  if (!options.quiet) std::printf("%s\nwrote %s\n", budgetTable(study).c_str(), (options.output / "index.html").c_str());
  return ExitCode::done;
}

}  // namespace chiaro
