#include "precompute/report/upsampling/upsampling_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "assets/builtin/environment.h"
#include "assets/error.h"
#include "assets/file.h"
#include "precompute/report/report_options.h"
#include "runtime/render/upsample_spec.h"

namespace chiaro {
namespace {

StudyMaterial materialFrom(const std::string& text) {
  const auto equals = text.find('=');
  const auto model = reflectanceFromName(text.substr(0, equals));
  float parameter = 0.0f;
  bool number = equals != std::string::npos;
  if (number) {
    const auto [end, status] = std::from_chars(text.data() + equals + 1, text.data() + text.size(), parameter);
    number = status == std::errc() && end == text.data() + text.size();
  }
  const bool exponent = model && hasExponent(*model);
  if (!model || !number || !(parameter >= (exponent ? kLeastExponent : kLeastWidth) && parameter <= (exponent ? kMostExponent : kMostWidth)))
    throw usageError("--material", "\"" + text + "\" is not a model and its width or exponent", "give one such as ggx=0.1 or blinnPhong=255");
  return {*model, parameter};
}

std::string namesOf(const std::vector<StudyVariant>& variants) {
  std::string names;
  for (const auto& one : variants) names += (names.empty() ? "" : ", ") + one.name;
  return names;
}

StudyVariant variantFrom(const std::string& name) {
  for (const auto& one : allVariants())
    if (one.name == name) return one;
  throw usageError("--variant", "\"" + name + "\" is none", "give one of " + namesOf(allVariants()));
}

void requireAngle(float value, const char* option) {
  if (!(std::abs(value) <= 360.0f)) throw usageError(option, "is out of range", "give degrees such as 0.5");
}

}  // namespace

void declareUpsamplingOptions(CLI::App& app, UpsamplingOptions& options) {
  auto& settings = options.settings;
  app.add_option("baked", options.scene, "Baked scene (.glb) that chiaro-precompute wrote")->required()->type_name("FILE");
  app.add_option("-o,--output", options.output, "Folder for upsampling.txt, upsampling.json and pictures of the last frames")->type_name("DIR");
  app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
  app.add_option("--material", options.materials, "A reflectance for the whole scene, such as ggx=0.1; may be repeated. Default: ten of them")
      ->type_name("MODEL=WIDTH")
      ->allow_extra_args(false);
  app.add_option("--variant", options.variants,
                 "What is compared with shading every pixel: " + namesOf(allVariants()) + "; may be repeated. Default: the first " + std::to_string(standardVariants().size()))
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_option("-e,--environment", settings.environment, "Light, as for chiaro-view")->type_name("NAME|FILE")->capture_default_str();
  app.add_option("--size", options.size, "Picture size in pixels")->type_name("WxH")->capture_default_str();
  app.add_option("--camera", options.camera, "As for chiaro-view, in the first frame")->type_name("SPEC")->capture_default_str();
  app.add_option("--upsample", settings.upsample, "Pixels a side of the cells of which one is shaded, 2 to 4")->type_name("N")->capture_default_str();
  app.add_option("--recompute-budget", options.recompute, "Most pixels that are shaded themselves, in the variants that do so")
      ->type_name("P%")
      ->capture_default_str();
  app.add_option("--frames", settings.frames, "Frames that count")->type_name("N")->capture_default_str();
  app.add_option("--warm-up", settings.warmUp, "Frames before those, which do not count")->type_name("N")->capture_default_str();
  app.add_option("--turn-deg", settings.turnDegrees, "How far the camera goes around what it looks at, a frame")->type_name("A")->capture_default_str();
  auto* moving = app.add_option("--moving", settings.moving, "A mesh of the scene that turns about +Y through its middle")->type_name("MESH");
  app.add_option("--moving-deg", settings.movingDegrees, "How far it turns, a frame")->type_name("A")->capture_default_str()->needs(moving);
  auto* frames = app.add_option("--vertex-frames", settings.shapes.frames, "Raw float32 x y z of every vertex of --vertex-rest, frame after frame: a mesh that changes shape")->type_name("FILE");
  auto* rest = app.add_option("--vertex-rest", settings.shapes.rest, "The mesh file (.ply, .off) that was baked")->type_name("FILE")->needs(frames);
  frames->needs(rest);
  app.add_option("--threads", settings.threads, "CPU threads, 0 is all; never changes the figures")->type_name("N")->capture_default_str();
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishUpsamplingOptions(UpsamplingOptions& options) {
  auto& settings = options.settings;
  for (const auto& text : options.materials) settings.materials.push_back(materialFrom(text));
  if (settings.materials.empty()) settings.materials = standardMaterials();
  for (const auto& name : options.variants) settings.variants.push_back(variantFrom(name));
  if (settings.variants.empty()) settings.variants = standardVariants();
  settings.size = sizeFrom(options.size);
  settings.camera = parseCameraSpec(options.camera);
  requireUpsample(settings.upsample, "--upsample");
  if (settings.upsample == 1) throw usageError("--upsample", "1 is what the others are compared with", "give 2, 3 or 4");
  const RecomputeBudget budget = parseRecomputeBudget(options.recompute);
  if (budget.milliseconds > 0.0f) throw usageError("--recompute-budget", "figures would depend on the machine", "give a share such as 10%");
  settings.recompute = budget.share;
  if (settings.frames < 1 || settings.frames > 10000) throw usageError("--frames", "must lie between 1 and 10000", "give a number such as 60");
  if (settings.warmUp < 0 || settings.warmUp > 10000) throw usageError("--warm-up", "must lie between 0 and 10000", "give a number such as 16");
  constexpr double kMostBytes = 8e9, kPixelBytes = 12.125;  // the full frames are kept
  if (kPixelBytes * settings.size.x * settings.size.y * settings.frames > kMostBytes)
    throw usageError("--frames", "so many frames of this size need more than 8 GB", "give fewer, or a smaller size");
  requireAngle(settings.turnDegrees, "--turn-deg");
  requireAngle(settings.movingDegrees, "--moving-deg");
  if (settings.threads < 0 || settings.threads > 1024) throw usageError("--threads", "must lie between 0 and 1024", "give 0 for all cores");
  requireEnvironment(settings.environment);
  if (!options.json.empty() && isSameFile(options.json, options.scene)) throw usageError("--json", "names the scene itself, which would be lost", "give another name");
  if (!options.output.empty()) {
    std::error_code failure;
    std::filesystem::create_directories(options.output, failure);
    if (failure) throw outputError(options.output.string(), "the folder cannot be made: " + failure.message(), "give another one with -o");
    requireWritable(options.output / "upsampling.json");
  }
  if (!options.json.empty()) requireWritable(options.json);
}

}  // namespace chiaro
