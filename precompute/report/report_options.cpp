#include "precompute/report/report_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "assets/builtin/environment.h"
#include "assets/error.h"
#include "assets/scene/light_spec.h"
#include "assets/scene/material_override.h"
#include "precompute/report/report_folder.h"

namespace chiaro {
namespace {

constexpr int kLargestSide = 4096;  // a reference larger than this takes hours
constexpr int kMostSamples = 1 << 20;

template <typename Number>
std::optional<Number> numberFrom(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<float> exposureFrom(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const auto value = numberFrom<float>(text);
  if (!value || !(*value > 0.0f) || !std::isfinite(*value))
    throw usageError("--exposure", "\"" + text + "\" is not a factor above 0", "give auto or a number such as 1.5");
  return value;
}

ErrorMapKind errorMapFrom(const std::string& text) {
  if (text == "difference") return ErrorMapKind::difference;
  if (text == "flip") return ErrorMapKind::flip;
  if (text == "hdr-flip") return ErrorMapKind::hdrFlip;
  throw usageError("--error-map", "unknown error map \"" + text + "\"", "give difference, flip or hdr-flip");
}

std::string builtinNames() {
  std::string text;
  for (const std::string& name : builtinEnvironmentNames()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void requireShare(float value, const char* option) {
  if (!(value >= 0.0f && value <= 1.0f)) throw usageError(option, "must lie between 0 and 1", "give a number such as 0.4");
}

}  // namespace

glm::ivec2 sizeFrom(const std::string& text) {
  const auto cross = text.find('x');
  const auto width = numberFrom<int>(std::string_view(text).substr(0, cross));
  const auto height = cross == std::string::npos ? std::nullopt : numberFrom<int>(std::string_view(text).substr(cross + 1));
  if (!width || !height) throw usageError("--size", "\"" + text + "\" is not a size", "give WIDTHxHEIGHT such as 480x300");
  if (*width < 1 || *height < 1 || *width > kLargestSide || *height > kLargestSide)
    throw usageError("--size", "\"" + text + "\" is out of range",
                     "each side must lie between 1 and " + std::to_string(kLargestSide));
  return {*width, *height};
}

void declareReportOptions(CLI::App& app, ReportOptions& options, ReportOptionTexts& texts) {
  app.add_option("baked", texts.scene, "Baked scene (.glb) that chiaro-precompute wrote")->required()->type_name("FILE");
  app.add_option("other", texts.other, "Another baked scene (.glb), whose pictures take the place of the brute-force reference")->type_name("OTHER");
  app.add_option("-o,--output", texts.output, "Folder for index.html, report.json, report.csv and the pictures")
      ->required()
      ->type_name("DIR");
  app.add_option("-e,--environment", options.environments,
                 "Light: " + builtinNames() + ", or an .hdr or .exr file. May be repeated. Default: sunny, overcast and windows")
      ->type_name("NAME|FILE")
      ->allow_extra_args(false);
  app.add_option("--light", texts.lights, "Another light beside the scene's own, as for chiaro-view. May be repeated")
      ->type_name("SPEC")
      ->allow_extra_args(false);
  app.add_option("-r,--roughness", options.roughnesses,
                 "Perceptual roughness of every material, 0 to 1. May be repeated: one comparison each")
      ->type_name("R")
      ->allow_extra_args(false);
  app.add_option("--metallic", options.metallic, "Metalness of every material, 0 to 1")->type_name("M");
  app.add_option("--model", texts.models, "Reflectance model of every material: " + reflectanceNameList() + ". May be repeated: one comparison each")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_flag("--energy-compensation", options.energyCompensation, "GGX gives back what scatters more than once, in both pictures");
  app.add_option("--lobes", options.lobes, "1, 3, 5, 7 or 9 lobes strung for every material; 0 is the best known")
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--size", texts.size, "Picture size in pixels")->type_name("WxH")->capture_default_str();
  app.add_option("--camera", texts.camera,
                 "auto (the file's first camera, else one that frames the scene), an index or name of a camera in the file, or "
                 "eye=X,Y,Z,target=X,Y,Z,fov-deg=D")
      ->type_name("SPEC")
      ->capture_default_str();
  app.add_option("--supersample", options.supersample, "N by N shaded points a pixel, 1 to 8, in both pictures")
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--samples", options.samples, "Sample pairs a pixel of the reference; its noise falls with their root")
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--exposure", texts.exposure, "Factor on radiance, or auto to suit each environment")
      ->type_name("auto|FACTOR")
      ->capture_default_str();
  app.add_option("--tone-map", texts.toneMap, "neutral, aces or clamp")->type_name("NAME")->capture_default_str();
  app.add_flag("--no-shadows", texts.noShadows, "Compare without shadows, to see the error of shading alone");
  app.add_option("--error-map", texts.errorMap, "difference (too bright, too dark), flip or hdr-flip")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("--fail-under", options.failUnder, "Exit with 5 when a comparison is under this PSNR")->type_name("DB");
  app.add_option("--fail-over", options.failOver, "Exit with 5 when the RMSE of a comparison, without the reference's noise, is over this")->type_name("X");
  app.add_option("--threads", options.threads, "CPU threads, 0 is all; never changes the figures")
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishReportOptions(ReportOptions& options, const ReportOptionTexts& texts) {
  options.scene = texts.scene;
  options.other = texts.other;
  options.output = texts.output;
  if (options.environments.empty()) options.environments = {"sunny", "overcast", "windows"};
  options.size = sizeFrom(texts.size);
  options.camera = parseCameraSpec(texts.camera);
  for (const auto& text : texts.lights) options.lights.push_back(parseLightSpec(text));
  options.exposure = exposureFrom(texts.exposure);
  options.toneMap = toneMapFromName(texts.toneMap);
  options.errorMap = errorMapFrom(texts.errorMap);
  options.shadows = !texts.noShadows;
  for (const float roughness : options.roughnesses) requireShare(roughness, "--roughness");
  if (options.metallic) requireShare(*options.metallic, "--metallic");
  for (const auto& text : texts.models) if (const auto model = modelFromOption(text)) options.models.push_back(*model);
  requireLobes(options.lobes, "--lobes");
  if (options.supersample < 1 || options.supersample > 8)
    throw usageError("--supersample", "must lie between 1 and 8", "give 2 to filter edges and textures");
  if (options.samples < 2 || options.samples > kMostSamples)
    throw usageError("--samples", "must lie between 2 and " + std::to_string(kMostSamples), "give a number such as 256");
  if (options.failUnder && !std::isfinite(*options.failUnder))
    throw usageError("--fail-under", "is not a number", "give decibels such as 30");
  if (options.failOver && !(*options.failOver >= 0.0 && std::isfinite(*options.failOver)))
    throw usageError("--fail-over", "is not a number from 0 on", "give an RMSE such as 0.01");
  if (options.threads < 0 || options.threads > 1024)
    throw usageError("--threads", "must lie between 0 and 1024", "give 0 for all cores");
  for (const std::string& name : options.environments) requireEnvironment(name);
  requireFolderCanBeMade(options.output);
}

}  // namespace chiaro
