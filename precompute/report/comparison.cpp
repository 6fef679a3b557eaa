#include "precompute/report/comparison.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <set>

#include "assets/builtin/environment.h"
#include "assets/scene/material_override.h"
#include "precompute/reference/reference.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/gl/context.h"
#include "runtime/render/renderer.h"

namespace chiaro {
namespace {

constexpr std::size_t kWorstPixels = 6;
constexpr int kWorstApart = 16;  // pixels

double secondsNow() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct PreparedLight {
  Environment environment;
  SgEnvironment prefiltered;
  float autoExposure = 1.0f;
  double seconds = 0.0;
};

PreparedLight prepareLight(const std::string& nameOrPath, int threads) {
  PreparedLight light;
  light.environment = loadEnvironment(nameOrPath);
  light.autoExposure = autoExposure(light.environment);
  const double start = secondsNow();
  SgEnvironmentSettings settings;
  settings.threads = threads;
  light.prefiltered = prepareEnvironment(light.environment, settings);
  light.seconds = secondsNow() - start;
  return light;
}

/// The scene with every material set; with nothing asked for, as it is.
BakedScene withMaterials(const BakedScene& baked, const MaterialOverride& materials) {
  BakedScene changed = baked;
  nameDefaultMaterial(changed.scene);
  overrideMaterials(changed.scene, materials);
  return changed;
}

std::string fileName(const std::string& environment, std::optional<Reflectance> model, std::optional<float> roughness, std::set<std::string>& taken) {
  std::string name = std::filesystem::path(environment).stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  if (name.empty()) name = "environment";
  if (model) name += "_" + reflectanceNames()[static_cast<std::size_t>(*model)];
  if (roughness) {
    char text[32];
    std::snprintf(text, sizeof text, "_r%.3g", static_cast<double>(*roughness));
    name += text;
    std::replace(name.begin(), name.end(), '.', 'p');
  }
  std::string unique = name;
  for (int k = 2; !taken.insert(unique).second; ++k) unique = name + "_" + std::to_string(k);
  return unique;
}

ImageRgba drawRuntime(const BakedScene& baked, const PreparedLight& light, const Camera& camera, const ReportOptions& options,
                      const DisplaySettings& display, double& seconds) {
  const double start = secondsNow();
  Renderer renderer(baked);
  renderer.setEnvironment(light.prefiltered);
  RenderSettings settings;
  settings.width = options.size.x;
  settings.height = options.size.y;
  settings.supersample = options.supersample;
  settings.exposure = display.exposure;
  settings.toneMap = display.toneMap;
  settings.shadows = options.shadows;
  settings.energyCompensation = options.energyCompensation;
  settings.lobes = options.lobes;
  renderer.render(camera, settings);
  auto picture = renderer.readRadiance();
  seconds = secondsNow() - start;
  return picture;
}

/// Two references of half the samples each, so that the noise is known.
ReferenceHalves drawReference(const Scene& scene, const Environment& environment, const Camera& camera,
                              const ReportOptions& options, const ProgressHandler& progress, Comparison& comparison) {
  const double start = secondsNow();
  ReferenceSettings settings;
  settings.width = options.size.x;
  settings.height = options.size.y;
  settings.samplesPerPixel = std::max(2, (options.samples + 1) / 2);
  settings.pixelGrid = options.supersample;
  settings.shadows = options.shadows;
  settings.energyCompensation = options.energyCompensation;
  settings.threads = options.threads;
  const auto half = [&](std::uint32_t seed) {
    settings.seed = seed;
    ReferenceImage image = renderReference(scene, environment, camera, settings, [&](const std::string&, double done) {
      if (progress) progress(comparison.name + ": reference", 0.5 * (seed + done));
    });
    comparison.rays += image.raysTraced;
    return std::move(image.radiance);
  };
  ReferenceHalves halves{half(0), half(1)};
  comparison.referenceSeconds = secondsNow() - start;
  return halves;
}

}  // namespace

double judgedError(const Comparison& one, const ReportOptions& options) {
  // Two bakes hold no noise, and then the bound of rmseWithoutNoise is only looser.
  return options.other.empty() ? one.difference.rmseWithoutNoise : one.difference.rmse;
}

Comparisons compareAll(const BakedScene& baked, const BakedScene* other, const ReportOptions& options, const ProgressHandler& progress) {
  Comparisons result;
  const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
  result.camera = resolveCamera(options.camera, baked.scene, aspect);
  gl::HeadlessContext context;
  result.glRenderer = context.renderer();
  result.glVersion = context.version();

  std::vector<std::optional<float>> roughnesses(options.roughnesses.begin(), options.roughnesses.end());
  if (roughnesses.empty()) roughnesses.push_back(std::nullopt);
  std::vector<std::optional<Reflectance>> models(options.models.begin(), options.models.end());
  if (models.empty()) models.push_back(std::nullopt);
  std::vector<std::pair<std::optional<Reflectance>, std::optional<float>>> materialCases;
  for (const auto& model : models)
    for (const auto& roughness : roughnesses) materialCases.emplace_back(model, roughness);
  std::set<std::string> names;
  for (const std::string& environment : options.environments) {
    if (progress) progress(environment + ": prefiltering", 0.0);
    const PreparedLight light = prepareLight(environment, options.threads);
    for (const auto& [model, roughness] : materialCases) {
      Comparison comparison;
      comparison.name = fileName(environment, model, roughness, names);
      comparison.environment = environment;
      comparison.model = model;
      comparison.roughness = roughness;
      comparison.display = {options.exposure.value_or(light.autoExposure), options.toneMap};
      comparison.lightCount = light.prefiltered.lights.size();
      comparison.prepareSeconds = light.seconds;
      const MaterialOverride materials{roughness, options.metallic, model};
      const BakedScene changed = withMaterials(baked, materials);
      comparison.runtime = drawRuntime(changed, light, result.camera, options, comparison.display, comparison.runtimeSeconds);
      ReferenceHalves halves;
      if (other != nullptr) {
        halves.first = drawRuntime(withMaterials(*other, materials), light, result.camera, options, comparison.display, comparison.referenceSeconds);
        halves.second = halves.first;
      } else {
        halves = drawReference(changed.scene, light.environment, result.camera, options, progress, comparison);
      }
      context.debugLog().requireClean("the rendering");
      comparison.reference = meanOf(halves);
      comparison.difference = comparePictures(comparison.runtime, halves, comparison.display);
      comparison.perceptual = comparePerceptually(comparison.runtime, comparison.reference, comparison.display, options.threads);
      comparison.worstPixels = worstPixels(comparison.runtime, comparison.reference, comparison.display, kWorstPixels, kWorstApart);
      result.cases.push_back(std::move(comparison));
    }
  }
  return result;
}

}  // namespace chiaro
