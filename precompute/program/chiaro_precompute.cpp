#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <string_view>

#include "assets/builtin/builtin_scene.h"
#include "assets/file.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "assets/program/program.h"
#include "assets/program/progress_bar.h"
#include "assets/scene/load_scene.h"
#include "assets/scene/material_override.h"
#include "assets/scene/material_replacement.h"
#include "assets/transfer/transfer.h"
#include "assets/transfer/transfer_format.h"
#include "precompute/bake.h"
#include "precompute/elapsed.h"
#include "precompute/journal/program_identity.h"
#include "precompute/memory_budget.h"
#include "precompute/preset.h"
#include "precompute/program/bake_json.h"
#include "precompute/program/material_program.h"

namespace {

using namespace chiaro;

constexpr const char* kExamples = R"(Examples:
  chiaro-precompute scene.glb -o baked.glb
  chiaro-precompute builtin:ornament -o ornament.glb
  chiaro-precompute bunny.ply -o bunny.glb --terms 96 --json bake.json
      more terms: sharper shadows of small lights, more bytes a vertex; bake.json says how far off each is
  chiaro-precompute bunny.ply -o bunny.glb --preset preview
  chiaro-precompute bunny.ply -o bunny.glb --target-error 0.02
      as few bytes as keep that error
  chiaro-precompute room.gltf -o room.glb --resolution 128 --threads 8
  chiaro-precompute room.gltf -o room.glb --refine 0.05
      more triangles where walls and floors have too few for their shadows
  chiaro-precompute statue.ply -o statue.glb --memory-limit 1024
      a million vertices in a gigabyte; stopped or killed, the same command goes on where it was
  chiaro-precompute material gold.binary -o gold.gltf
      a measured reflectance as a material; has options of its own, see chiaro-precompute material --help
  chiaro-precompute room.gltf --material handle=gold.gltf -o room.glb
  chiaro-view baked.glb
      shows the result

Scenes: .gltf, .glb, .obj, .ply, .off, .stl, or builtin:NAME.
Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted (the output is not
written; the same command goes on from FILE.glb.partial).)";

struct Options {
  std::string scene;
  std::filesystem::path output;
  std::filesystem::path json;
  std::vector<std::string> materials;  ///< NAME=FILE
  std::string preset;                  ///< name; empty: none
  BakeSettings settings;
  double creaseAngleDegrees = 60.0;
  double memoryLimitMib = 0.0;
  bool fresh = false;
  double leastOccluderDegrees = 0.0;
  bool quiet = false;
  bool verbose = false;
};

void declare(CLI::App& app, Options& options) {
  auto& settings = options.settings;
  const auto shown = [](CLI::Option* option, const char* type) { option->type_name(type)->capture_default_str(); };
  app.add_option("scene", options.scene, "Scene file, or builtin:NAME")->required()->type_name("FILE|builtin:NAME");
  app.add_option("-o,--output", options.output, "Baked scene to write (.glb)")->required()->type_name("FILE");
  app.add_option("--json", options.json, "Also write sizes, seconds, errors and repairs here")->type_name("FILE");

  app.add_option("--material", options.materials, "Put the material of a glTF file on the scene's material of this name (\"default\" where there is none); may be repeated")
      ->type_name("NAME=FILE.gltf")
      ->allow_extra_args(false);

  app.add_option("--preset", options.preset, "preview, balanced or quality: --resolution and --bytes at once; what is given beside it counts")->type_name("NAME");
  const std::map<std::string, Compression> forms{{"pca", Compression::pca}, {"clustered", Compression::clustered}, {"joint", Compression::joint}};
  app.add_option("--compression", settings.compression, "pca (global), clustered, or joint (clustered, with prefiltered visibility)")
      ->transform(CLI::CheckedTransformer(forms, CLI::ignore_case))->option_text("pca|clustered|joint");
  shown(app.add_option("--clusters", settings.clusters, "Clusters, 0 is by the number of vertices"), "N");
  shown(app.add_option("--functions", settings.functions, "Functions that clusters share, 0 is by the number of vertices"), "N");
  shown(app.add_option("--weight-bits", settings.weightBits, "Bits of a weight, 8 or 16"), "N");
  shown(app.add_option("--bytes", settings.bytesPerVertex, "Bytes a vertex, all counted, that rounding has to fit; 0: 104, or more in small scenes; below 0: no limit"), "N");
  shown(app.add_option("--target-error", settings.targetError,
                       "As few bytes as keep the mean error of visible fractions at or below this; chooses bytes, functions and clusters; 0 is off"), "E");
  shown(app.add_option("--function-bits", settings.functionBits, "Bits of a function's values: 16, 8, 4, or 0 for steps that follow from the bytes"), "N");
  shown(app.add_option("--resolution", settings.resolution, "Texels a side of the octahedral sphere, 16 to 256, a multiple of 4"), "N");
  shown(app.add_option("--sample-resolution", settings.samplingResolution,
                       "Texels a side traced where visibility changes: --resolution times a power of two; 0 is four times, at most 256"),
        "N");
  shown(app.add_option("--least-occluder", options.leastOccluderDegrees,
                       "Never miss an occluder of this many degrees, at the cost of more rays; 0 promises nothing"),
        "A");
  shown(app.add_option("--terms", settings.terms, "Weights a lookup fetches at most, 1 to 256; 0 is 24, or 48 with pca"), "K");
  shown(app.add_option("--directions", settings.directionCount, "Broad lobes a vertex, 8 to 64, a multiple of 4"), "N");
  shown(app.add_option("--crease-angle-deg", options.creaseAngleDegrees,
                       "Where a file has no normals, edges bent by more than this stay sharp, 0 to 180"),
        "A");
  shown(app.add_option("--refine", settings.refine.error,
                       "Split triangles until interpolating what corners see is wrong by at most this share, 0 to 1; 0 is off"),
        "E");
  shown(app.add_option("--refine-vertices", settings.refine.mostVertices, "Most vertices the scene may have after --refine"), "N");
  shown(app.add_option("--seed", settings.seed, "Of the random choices; the same seed gives the same file"), "N");
  shown(app.add_option("--threads", settings.threads, "CPU threads, 0 is all; never changes the result"), "N");
  shown(app.add_option("--memory-limit", options.memoryLimitMib,
                       "MiB of memory to stay within, 0 is no limit; the rest is kept on disk, in FILE.partial; never changes the result"),
        "MIB");
  app.add_flag("--fresh", options.fresh, "Do not go on from what a bake of the same output left when it was stopped");
  auto* quiet = app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
  app.add_flag("-v,--verbose", options.verbose, "Print warnings and every figure")->excludes(quiet);
}

/// What the preset says and the command line does not.
void applyPreset(const CLI::App& app, Options& options) {
  if (options.preset.empty()) return;
  std::string names;
  for (const auto& preset : kPresets) {
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
    if (preset.name != options.preset) continue;
    if (options.settings.compression != Compression::joint) throw usageError("--preset", "is of the joint form", "leave --compression out, or the preset");
    if (options.settings.targetError > 0.0) throw usageError("--preset", "and --target-error both choose the bytes", "give one of them");
    if (app.count("--resolution") == 0) options.settings.resolution = preset.resolution;
    if (app.count("--bytes") == 0) options.settings.bytesPerVertex = preset.bytesPerVertex;
    return;
  }
  throw usageError("--preset", "unknown preset \"" + options.preset + "\"", "give one of " + names);
}

/// Whether a bake wrote this file: it may be baked again in its own place. An artist's own file must not be replaced.
bool isBaked(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  const std::string_view mark = kTransferExtension;
  return std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end()) != bytes.end();
}

/// What is finished of a bake that is not over lies beside its output.
std::filesystem::path partialOf(const std::filesystem::path& output) {
  auto path = output;
  return path += ".partial";
}

void finish(Options& options) {
  auto& settings = options.settings;
  const auto inRange = [](const char* name, double value, double least, double most) {
    if (value >= least && value <= most) return;
    char range[64];
    std::snprintf(range, sizeof range, "give a value from %g to %g", least, most);
    throw usageError(name, "is out of range", range);
  };
  inRange("--resolution", settings.resolution, 16, 256);
  inRange("--terms", settings.terms, 0, 256);
  inRange("--directions", settings.directionCount, 8, 64);
  inRange("--crease-angle-deg", options.creaseAngleDegrees, 0, 180);
  inRange("--refine", static_cast<double>(settings.refine.error), 0, 1);
  inRange("--refine-vertices", static_cast<double>(settings.refine.mostVertices), 0, 1e9);
  inRange("--threads", settings.threads, 0, 1024);
  inRange("--memory-limit", options.memoryLimitMib, 0, 1e9);
  if (settings.resolution % 4 != 0) throw usageError("--resolution", "is not a multiple of 4", "use 32, 64, 128, ...");
  if (settings.directionCount % 4 != 0) throw usageError("--directions", "is not a multiple of 4", "use 16, 32, 64, ...");
  inRange("--least-occluder", options.leastOccluderDegrees, 0, 90);
  settings.leastOccluder = static_cast<float>(options.leastOccluderDegrees * std::numbers::pi / 180.0);
  settings = resolvedSettings(settings);
  settings.creaseAngle = static_cast<float>(options.creaseAngleDegrees * std::numbers::pi / 180.0);

  if (options.output.extension() != ".glb")
    throw usageError("--output", "\"" + options.output.string() + "\" does not end in .glb", "name it so: it is a binary glTF");
  if (isSameFile(options.json, options.output)) throw usageError("--json", "names the same file as --output", "give two names");
  if (isSameFile(options.json, partialOf(options.output)))
    throw usageError("--json", "names the file of what is finished so far", "give another name");
  const auto lost = [](const char* option) { return usageError(option, "names the scene itself, which would be lost", "give another name"); };
  if (isSameFile(options.json, options.scene)) throw lost("--json");
  if (isSameFile(options.output, options.scene) && !isBaked(options.scene)) throw lost("--output");
  for (const std::string& one : options.materials) {
    const auto equals = one.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == one.size()) throw usageError("--material", "\"" + one + "\" is not NAME=FILE", "write such as body=gold.gltf");
    if (isSameFile(options.json, one.substr(equals + 1))) throw usageError("--json", "names a material, which would be lost", "give another name");
  }
  // An hour's work should not be lost to a typing mistake.
  requireWritable(options.output);
  requireWritable(partialOf(options.output));
  if (!options.json.empty()) requireWritable(options.json);
}

void printRepairs(const RepairReport& repairs) {
  const std::pair<std::size_t, const char*> counts[] = {
      {repairs.weldedVertices, "equal vertices merged"},
      {repairs.isolatedVertices, "unused vertices dropped"},
      {repairs.degenerateTriangles, "triangles without area dropped"},
      {repairs.duplicateTriangles, "repeated triangles dropped"},
      {repairs.trianglesTurned, "triangles of an inside-out mesh turned"},
      {repairs.nonManifoldEdges, "non-manifold edges kept"},
      {repairs.boundaryEdges, "boundary edges"},
      {repairs.normalsComputed, "normals computed"},
      {repairs.normalsRepaired, "normals repaired"},
      {repairs.tangentsComputed, "tangents computed"},
  };
  for (const auto& [count, what] : counts)
    if (count > 0) std::printf("  %zu %s\n", count, what);
}

void printRefinement(double error, const RefineReport& refinement) {
  std::printf("refined: %zu vertices and %zu triangles added in %d passes", refinement.verticesAdded, refinement.trianglesAdded, refinement.passes);
  if (refinement.edgesTooShort > 0) std::printf(", %zu of its edges too short to be split and still above %g", refinement.edgesTooShort, error);
  if (refinement.edgesOverBudget > 0)
    std::printf(", %zu edges left above %g because the vertices ran out (--refine-vertices)", refinement.edgesOverBudget, error);
  std::printf("\n");
}

void printSummary(const Options& options, const BakeRun& run, const BakeReport& report) {
  std::printf("%s: %zu vertices, %zu triangles, %d terms, %.0f bytes a vertex, %.2f million rays, %.1f s\n", options.output.c_str(),
              report.vertices, report.triangles, report.terms, report.bytesPerVertex, static_cast<double>(report.raysTraced) * 1e-6,
              run.loadSeconds + report.seconds.total + run.writeSeconds);
  if (options.settings.refine.error > 0.0f) printRefinement(static_cast<double>(options.settings.refine.error), report.refinement);
  // What the user made and will miss in the picture is said without being asked for; each line of it with --verbose.
  if (!run.warnings.empty() && !options.verbose)
    std::printf("%zu warning%s: %s%s\n", run.warnings.size(), run.warnings.size() == 1 ? "" : "s", run.warnings.front().c_str(),
                run.warnings.size() == 1 ? "" : ", ... (--verbose or --json lists them)");
  if (options.verbose) {
    std::printf("repairs:\n");
    printRepairs(report.repairs);
    std::printf("seconds:\n  refinement %.2f\n  visibility %.2f\n  ssdf %.2f\n  compression %.2f\n", report.refinement.seconds,
                report.seconds.visibility, report.seconds.ssdf, report.seconds.compression);
    std::printf("error:\n");
    for (const auto& [name, value] : report.error) std::printf("  %-46s %.5f\n", name.c_str(), value);
    std::printf("peak memory: %.0f MiB\n", static_cast<double>(run.peakMemoryBytes) / 1048576.0);
  }
}

void replaceMaterials(const Options& options, Scene& scene, const WarningHandler& warn) {
  if (options.materials.empty()) return;
  nameDefaultMaterial(scene);
  for (const std::string& one : options.materials) replaceMaterial(scene, one.substr(0, one.find('=')), one.substr(one.find('=') + 1), warn);
}

/// bake() knows no file names; the user knows nothing else.
template <typename Work>
auto naming(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (error.where() != "scene") throw;
    throw Error(error.code(), file, std::string(error.what()).substr(error.where().size() + 2), "");
  }
}

ExitCode precompute(int argc, char** argv) {
  CLI::App app("Bakes the radiance transfer of a scene: what each vertex sees, compressed, in one .glb.", "chiaro-precompute");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-precompute " CHIARO_VERSION);
  Options options;
  declare(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  applyPreset(app, options);
  finish(options);
  catchInterrupts();

  ProgressBar bar(progressStyle(options.quiet));
  BakeRun run{.input = options.scene, .output = options.output.string(), .version = CHIARO_VERSION, .settings = options.settings, .memoryLimitMib = options.memoryLimitMib};
  const auto loadStart = Clock::now();
  const auto warn = [&](const std::string& warning) {
    run.warnings.push_back(warning);
    if (options.verbose) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  };
  auto scene = isBuiltinName(options.scene) ? builtinScene(options.scene.substr(options.scene.find(':') + 1)) : loadScene(options.scene, warn);
  replaceMaterials(options, scene, warn);
  run.loadSeconds = secondsSince(loadStart);
  throwIfInterrupted();

  bar.setItems(scene.vertexCount(), "vertices");
  BakeReport report;
  const BakeStorage storage{.journal = partialOf(options.output),
                            .fresh = options.fresh,
                            .program = programIdentity("chiaro-precompute " CHIARO_VERSION),  // a bake that goes on must be the same program's
                            .memoryLimit = static_cast<std::size_t>(std::ceil(options.memoryLimitMib * 1048576.0)),
                            .notice = [&](const std::string& line) {
                              bar.clear();
                              if (!options.quiet) std::fprintf(stderr, "chiaro-precompute: %s\n", line.c_str());
                            }};
  const auto baked = naming(options.scene, [&] {
    try {
      return bake(std::move(scene), options.settings, report,
                  [&](const std::string& stage, double done) {
                    throwIfInterrupted();
                    bar.update(stage, done);
                  },
                  storage);
    } catch (const Error& error) {
      if (error.code() != ExitCode::interrupted || !std::filesystem::exists(storage.journal)) throw;
      throw Error(ExitCode::interrupted, "interrupted", "the output is not written, what is finished is in " + storage.journal.string(),
                  "run the same command again to go on, or remove that file");
    }
  });
  bar.clear();
  if (const double wanted = run.settings.bytesPerVertex; wanted > 0.0 && report.bytesPerVertex > 1.02 * wanted)
    run.warnings.push_back("--bytes " + std::to_string(std::lround(wanted)) + " cannot be kept: what all vertices share takes " +
                           std::to_string(std::lround(report.bytesPerVertex)) + " of each: give fewer --functions and --clusters, or a lower --resolution");
  if (report.missedTarget)
    run.warnings.push_back("--target-error is not reached with " + std::to_string(std::lround(report.bytesPerVertex)) +
                           " bytes a vertex: give more --terms, --resolution or --sample-resolution, or --refine");

  const auto writeStart = Clock::now();
  throwIfInterrupted();
  writeBakedScene(options.output, baked, "chiaro-precompute " CHIARO_VERSION);
  std::error_code ignored;
  std::filesystem::remove(storage.journal, ignored);
  run.writeSeconds = secondsSince(writeStart);
  run.peakMemoryBytes = peakResidentBytes();
  if (!options.json.empty()) writeFileAtomically(options.json, bakeJson(run, report));
  if (!options.quiet) printSummary(options, run, report);
  return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
  return chiaro::runMain("chiaro-precompute", [&] {
    if (argc > 1 && std::string_view(argv[1]) == "material") return chiaro::materialProgram(argc - 1, argv + 1);
    return precompute(argc, argv);
  });
}
