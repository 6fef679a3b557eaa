#include "runtime/viewer/view_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "assets/builtin/environment.h"
#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/light_spec.h"
#include "runtime/render/upsample_spec.h"

namespace chiaro {
namespace {

constexpr int kLargestSide = 16384;  // what every OpenGL 4.5 driver allows a texture

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::optional<int> wholeNumber(std::string_view text) {
  int value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<float> parseExposure(const std::string& text) {
  if (text == "auto") return std::nullopt;
  float value = 0.0f;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !(value > 0.0f) || !std::isfinite(value))
    throw usageError("--exposure", "\"" + text + "\" is not a factor above 0", "give auto or a number such as 1.5");
  return value;
}

ViewMode modeOf(const ViewOptionTexts& texts) {
  if (texts.headless && texts.window) throw usageError("--window", "contradicts --headless", "give one of the two");
  if (texts.headless) return ViewMode::headless;
  return texts.window ? ViewMode::window : ViewMode::interactive;
}

void checkOutputs(const ViewOptions& options, const ViewOptionTexts& texts) {
  const bool any = !texts.picture.empty() || !texts.timings.empty();
  if (options.mode == ViewMode::interactive) {
    const char* given = !texts.picture.empty() ? "--output" : !texts.timings.empty() ? "--json" : texts.framesGiven ? "--frames" : nullptr;
    if (given != nullptr) throw usageError(given, "needs a run that ends", "add --headless, or --window for one in a window");
    return;
  }
  if (!any) throw usageError("--output", "there is nothing to write", "give -o FILE, --json FILE or both");
  if (options.environments.size() > 1)
    throw usageError("--environment", "a picture has one environment, not " + std::to_string(options.environments.size()), "run once for each");
  if (!options.picture.empty()) {
    pictureFormat(options.picture, "--output");
    requireWritable(options.picture);
  }
  if (!options.timings.empty()) requireWritable(options.timings);
  if (isSameFile(options.picture, options.timings)) throw usageError("--json", "names the same file as --output", "give two names");
  if (isSameFile(options.timings, options.scene)) throw usageError("--json", "names the scene itself, which would be lost", "give another name");
  for (const auto& environment : options.environments)
    for (const auto& [path, option] : {std::pair{options.picture, "--output"}, std::pair{options.timings, "--json"}})
      if (isSameFile(path, environment)) throw usageError(option, "names the environment itself, which would be lost", "give another name");
}

}  // namespace

void declareViewOptions(CLI::App& app, ViewOptions& options, ViewOptionTexts& texts) {
  app.add_option("baked", texts.scene, "Baked scene (.glb) that chiaro-precompute wrote")->required()->type_name("FILE");
  app.add_option("-e,--environment", options.environments,
                 "Light: " + joined(builtinEnvironmentNames()) + ", or an .hdr or .exr file. May be repeated in a window. Default: sunny")
      ->type_name("NAME|FILE")
      ->allow_extra_args(false);
  app.add_option("--rotate-environment-deg", options.rotateEnvironmentDegrees, "Turn the environment about +Y")->type_name("A");
  app.add_option("--light", texts.lights,
                 "Another light beside the scene's own, such as sphere,at=X,Y,Z,radius=R,intensity=R,G,B: sun, point, spot, sphere or disk with "
                 "at, direction or target, radius, angle-deg, intensity, cone-deg, range. May be repeated")
      ->type_name("SPEC")
      ->allow_extra_args(false);

  const std::string view = "View";
  app.add_option("--size", texts.size, "Picture or window size in pixels")->type_name("WxH")->capture_default_str()->group(view);
  app.add_option("--camera", texts.camera,
                 "auto (the file's first camera, else one that frames the scene), an index or name of a camera in the file, or "
                 "eye=X,Y,Z,target=X,Y,Z,fov-deg=D")
      ->type_name("SPEC")->capture_default_str()->group(view);
  app.add_option("--orbit", texts.orbit, "Then carry the camera around what it looks at, in degrees")
      ->type_name("AZIMUTH,ELEVATION")->capture_default_str()->group(view);
  app.add_option("--exposure", texts.exposure, "Factor on radiance, or auto to suit the environment")
      ->type_name("auto|FACTOR")->capture_default_str()->group(view);
  app.add_option("--tone-map", texts.toneMap, "neutral, aces or clamp")->type_name("NAME")->capture_default_str()->group(view);
  app.add_option("--supersample", options.supersample, "N x N shaded points a pixel, 1 to 8")
      ->type_name("N")->capture_default_str()->group(view);
  app.add_flag("--no-background", texts.noBackground, "Leave what no object covers black")->group(view);
  app.add_flag("--no-shadows", texts.noShadows, "Ignore the baked transfer")->group(view);
  app.add_option("--debug-view", texts.debugView, "Show " + joined(debugViewNames()) + " instead of the picture")
      ->type_name("NAME")->capture_default_str()->group(view);
  app.add_option("--upsample", options.upsample, "Shade one point of N x N pixels, 1 to 4, and make the others of these and of the frames before")
      ->type_name("N")->capture_default_str()->group(view);
  app.add_option("--upsample-weights", texts.upsampleWeights, "What makes a sample fit a pixel: " + joined(upsampleWeightNames()))
      ->type_name("NAME")->capture_default_str()->group(view);
  app.add_option("--recompute-budget", texts.recompute, "Most pixels that are shaded because no sample fits them: a share such as 10%, or GPU time such as 2ms")
      ->type_name("P%|Tms")->capture_default_str()->group(view);
  app.add_option("--roughness", texts.roughness, "Perceptual roughness of every material, 0 to 1")->type_name("R")->group(view);
  app.add_option("--metallic", texts.metallic, "Metalness of every material, 0 to 1")->type_name("M")->group(view);

  app.add_option("--animate", texts.animate, "none; wetness: a shower wets everything puddle by puddle and it dries again, in 4 seconds or 240 frames of a run that ends; scene: the file's own animation, over and over")
      ->type_name("NAME")->capture_default_str()->group(view);
  app.add_option("--moving", options.moving, "A mesh of the scene that turns about +Y through its middle, 30 degrees a second, of which a run that ends has 60 frames")->type_name("MESH")->group(view);
  auto* frames = app.add_option("--vertex-frames", options.shapes.frames, "Raw float32 x y z of every vertex of --vertex-rest, frame after frame, 30 a second, forth and back")->type_name("FILE")->group(view);
  auto* rest = app.add_option("--vertex-rest", options.shapes.rest, "The mesh file (.ply, .off) that was baked")->type_name("FILE")->group(view)->needs(frames);
  frames->needs(rest);
  app.add_option("--start", options.startSeconds, "Where the animations start, in seconds")->type_name("S")->capture_default_str()->group(view);
  app.add_option("--model", texts.model, "Reflectance model of every material: " + reflectanceNameList())->type_name("NAME")->group(view);
  app.add_flag("--energy-compensation", options.energyCompensation, "GGX gives back what scatters more than once between its facets")->group(view);
  app.add_option("--lobes", options.lobes, "1, 3, 5, 7 or 9 lobes strung for every material (GGX: three times as many); 0 is the best known")
      ->type_name("N")->capture_default_str()->group(view);
  app.add_option("--prefilter", options.prefilter, "Texels a side of a face of the sharpest prefiltered environment, a power of two, 16 to 1024")
      ->type_name("N")->capture_default_str()->group(view);

  const std::string files = "Runs that end";
  app.add_flag("--headless", texts.headless, "Draw without a window")->group(files);
  app.add_flag("--window", texts.window, "Draw in a window that closes when done")->group(files);
  app.add_option("-o,--output", texts.picture, "Picture: .png as the screen shows it, .exr linear radiance with coverage in alpha")
      ->type_name("FILE")->group(files);
  app.add_option("--json", texts.timings, "Sizes and seconds, and the GPU milliseconds of each pass")->type_name("FILE")->group(files);
  app.add_option("--frames", options.frames, "Frames to time; above 1, after one that is not counted")
      ->type_name("N")->capture_default_str()->group(files);
  app.add_option("--threads", options.threads, "CPU threads that prepare the environment; 0 is all")
      ->type_name("N")->capture_default_str();
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishViewOptions(ViewOptions& options, const ViewOptionTexts& texts) {
  options.scene = texts.scene;
  options.picture = texts.picture;
  options.timings = texts.timings;
  options.mode = modeOf(texts);
  options.size = parseSize(texts.size);
  options.camera = parseCameraSpec(texts.camera);
  options.orbit = parseOrbit(texts.orbit);
  options.exposure = parseExposure(texts.exposure);
  options.toneMap = toneMapFromName(texts.toneMap);
  options.debugView = debugViewFromName(texts.debugView);
  requireUpsample(options.upsample, "--upsample");
  options.upsampleWeights = upsampleWeightsFromName(texts.upsampleWeights);
  options.recompute = parseRecomputeBudget(texts.recompute);
  if (options.debugView >= DebugView::totalWeight && options.upsample == 1)
    throw usageError("--debug-view", texts.debugView + " needs upsampling", "add --upsample 4");
  options.shadows = !texts.noShadows;
  options.background = !texts.noBackground;
  options.materials = {texts.roughness, texts.metallic, modelFromOption(texts.model)};
  requireLobes(options.lobes, "--lobes");
  requireFinestResolution(options.prefilter, "--prefilter");
  options.animation = animationFromName(texts.animate);
  if (!(std::abs(options.startSeconds) <= 1e6)) throw usageError("--start", "must lie between -1e6 and 1e6", "give seconds such as 1.5");
  for (const auto& text : texts.lights) options.lights.push_back(parseLightSpec(text));
  for (const auto& [value, option] : {std::pair{texts.roughness, "--roughness"}, std::pair{texts.metallic, "--metallic"}})
    if (value && !(*value >= 0.0f && *value <= 1.0f)) throw usageError(option, "must lie between 0 and 1", "give a number such as 0.4");
  if (options.supersample < 1 || options.supersample > 8) throw usageError("--supersample", "must lie between 1 and 8", "give a number such as 2");
  if (options.frames < 1 || options.frames > 1'000'000) throw usageError("--frames", "must lie between 1 and 1000000", "give a number such as 20");
  if (options.threads < 0 || options.threads > 1024) throw usageError("--threads", "must lie between 0 and 1024", "give 0 for all cores");
  if (!std::isfinite(options.rotateEnvironmentDegrees)) throw usageError("--rotate-environment-deg", "is not a number", "give degrees such as 90");
  if (options.environments.empty()) options.environments = {"sunny"};

  checkOutputs(options, texts);
  for (const auto& name : options.environments) requireEnvironment(name);
}

glm::ivec2 parseSize(const std::string& text) {
  const auto cross = text.find('x');
  const auto width = wholeNumber(std::string_view(text).substr(0, cross));
  const auto height = cross == std::string::npos ? std::nullopt : wholeNumber(std::string_view(text).substr(cross + 1));
  if (!width || !height) throw usageError("--size", "\"" + text + "\" is not a size", "give WIDTHxHEIGHT such as 1280x720");
  if (*width < 1 || *height < 1 || *width > kLargestSide || *height > kLargestSide)
    throw usageError("--size", "\"" + text + "\" is out of range", "each side must lie between 1 and " + std::to_string(kLargestSide));
  return {*width, *height};
}

const std::vector<std::string>& debugViewNames() {
  static const std::vector<std::string> kNames{"none", "albedo", "normal", "roughness", "visibility", "ssdf", "total-weight", "age", "recomputed"};
  return kNames;
}

DebugView debugViewFromName(const std::string& name) {
  const auto& names = debugViewNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw usageError("--debug-view", "unknown view \"" + name + "\"", "give one of " + joined(names));
  return static_cast<DebugView>(found - names.begin());
}

PictureFormat pictureFormat(const std::filesystem::path& path, const std::string& option) {
  const std::string extension = lowerCaseExtension(path);
  if (extension == ".png") return PictureFormat::png;
  if (extension == ".exr") return PictureFormat::exr;
  throw usageError(option, "\"" + path.string() + "\" is neither a .png nor an .exr name", "end the name in .png or .exr");
}

glm::mat3 environmentRotation(double degrees) {
  const double radians = std::remainder(degrees, 360.0) * (std::numbers::pi / 180.0);
  return glm::mat3(glm::rotate(glm::mat4(1.0f), static_cast<float>(radians), glm::vec3(0, 1, 0)));
}

}  // namespace chiaro
