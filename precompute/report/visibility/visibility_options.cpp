#include "precompute/report/visibility/visibility_options.h"

#include <CLI/CLI.hpp>

#include "assets/builtin/builtin_scene.h"
#include "assets/error.h"
#include "assets/file.h"

namespace chiaro {
namespace {

void requireRange(const char* option, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw usageError(option, "is out of range", "give a value from " + std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

void declareVisibilityOptions(CLI::App& app, VisibilityOptions& options) {
  auto& settings = options.settings;
  const auto shown = [](CLI::Option* option) { option->type_name("N")->capture_default_str(); };
  app.add_option("scenes", options.scenes, "Scene files, baked or not, or builtin:NAME; a baked one is measured too")
      ->required()
      ->type_name("SCENE");
  app.add_option("-o,--output", options.output, "Folder for index.html, visibility.txt, visibility.json and visibility.csv")
      ->type_name("DIR");
  app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
  shown(app.add_option("--vertices", settings.vertices, "Random vertices to measure at"));
  shown(app.add_option("--points-inside", settings.points, "Random points inside triangles to measure at"));
  shown(app.add_option("--rays", settings.rays, "Rays of the truth, a lobe"));
  shown(app.add_option("--resolution", settings.resolution, "Texels a side of the octahedral maps, 16 to 256, a multiple of 4"));
  shown(app.add_option("--terms", settings.terms, "Principal components, 1 to 256"));
  shown(app.add_option("--basis-vertices", settings.basisVertices, "Most random vertices that the components are computed from"));
  app.add_flag("--ground", options.ground,
               "Put a square of 1600 vertices, three diagonals wide, under scenes that are not baked");
  app.add_option("--bake", options.bake, "Bake scenes that are not baked with so many bytes a vertex (0: as a bake chooses), else with default settings, and measure that; may be repeated")
      ->type_name("BYTES");
  app.add_flag("--figures", options.figures, "Also figures 7 and 10 of the supplement of Wang et al. 2009: errors of products with a signed distance, and by the number of terms");
  shown(app.add_option("--seed", settings.seed, "Of the random choices"));
  shown(app.add_option("--threads", settings.threads, "CPU threads, 0 is all; never changes the figures"));
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishVisibilityOptions(const VisibilityOptions& options) {
  const auto& settings = options.settings;
  requireRange("--vertices", settings.vertices, 0, 1 << 20);
  requireRange("--points-inside", settings.points, 0, 1 << 20);
  if (settings.vertices + settings.points == 0)
    throw usageError("--vertices", "there is nothing to measure", "give a number above 0");
  requireRange("--rays", settings.rays, 32, 1 << 20);
  requireRange("--resolution", settings.resolution, 16, 256);
  if (settings.resolution % 4 != 0) throw usageError("--resolution", "is not a multiple of 4", "use 32, 64, 128, ...");
  requireRange("--terms", settings.terms, 1, 256);
  requireRange("--basis-vertices", settings.basisVertices, 1, 1 << 20);
  for (const double bytes : options.bake)
    if (!(bytes >= 0.0 && bytes <= 1e6)) throw usageError("--bake", "is not a number of bytes", "give a number such as 104");
  requireRange("--threads", settings.threads, 0, 1024);
  for (const auto& scene : options.scenes)
    if (!options.json.empty() && !isBuiltinName(scene) && isSameFile(options.json, scene))
      throw usageError("--json", "names a scene, which would be lost", "give another name");
  if (!options.output.empty()) {
    std::error_code failure;
    std::filesystem::create_directories(options.output, failure);
    if (failure)
      throw outputError(options.output.string(), "the folder cannot be made: " + failure.message(), "give another one with -o");
    requireWritable(options.output / "visibility.json");
  }
  if (!options.json.empty()) requireWritable(options.json);
}

}  // namespace chiaro
