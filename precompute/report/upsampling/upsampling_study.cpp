#include "precompute/report/upsampling/upsampling_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "assets/builtin/environment.h"
#include "assets/error.h"
#include "assets/scene/material_override.h"
#include "assets/scene/moving_mesh.h"
#include "precompute/report/metrics.h"
#include "precompute/report/metrics/flip.h"
#include "precompute/report/metrics/rmse.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/render/renderer.h"

namespace chiaro {
namespace {

float radians(double degrees) { return static_cast<float>(degrees * std::numbers::pi / 180.0); }

std::vector<Material> materialsOf(Scene scene, const StudyMaterial& material) {
  overrideMaterials(scene, {.roughness = 0.5f, .metallic = 1.0f, .model = material.model});
  for (auto& m : scene.materials) {
    m.anisotropyStrength = 0.0f;
    m.anisotropyTexture = kNone;
    m.clearcoatFactor = 0.0f;
    m.reflectanceWidth = glm::vec2(material.parameter);
  }
  return scene.materials;
}

/// Camera and poses of a frame; negative ones come before those that count.
class Path {
 public:
  Path(const Scene& scene, const UpsamplingSettings& settings) : settings_(settings), bounds_(boundsOf(scene)), rest_(scene.meshNames.size(), glm::mat4(1.0f)) {
    const float aspect = static_cast<float>(settings.size.x) / static_cast<float>(settings.size.y);
    start_ = resolveCamera(settings.camera, scene, aspect);
    if (!settings.moving.empty()) mesh_.emplace(scene, settings.moving);
  }

  Camera camera(int frame) const {
    Camera turned = orbited(start_, orbitTarget(start_, bounds_), radians(static_cast<double>(settings_.turnDegrees) * frame), 0.0f);
    fitDepthRange(turned, bounds_);
    return turned;
  }

  std::vector<glm::mat4> poses(int frame) const {
    // Far from where it was baked: a turn of 0 is no movement.
    return mesh_ ? mesh_->poses(static_cast<double>(settings_.movingDegrees) * (frame + 1000)) : rest_;
  }

 private:
  const UpsamplingSettings& settings_;
  Bounds bounds_;
  Camera start_;
  std::vector<glm::mat4> rest_;
  std::optional<MovingMesh> mesh_;
};

struct Frames {
  std::vector<ImageRgb> shown;      ///< tone-mapped and encoded
  std::vector<PixelMask> objects;
  std::vector<double> milliseconds, filterMilliseconds, recomputed;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

Frames draw(Renderer& renderer, Path path, const RenderSettings& settings, const UpsamplingSettings& study, const std::function<void(double)>& progress) {
  Frames frames;
  const int warmUp = settings.upsample > 1 ? study.warmUp : 0;
  const double pixels = static_cast<double>(study.size.x) * study.size.y;
  for (int f = -warmUp; f < study.frames; ++f) {
    progress(static_cast<double>(f + warmUp) / (study.frames + warmUp));
    renderer.setPoses(path.poses(f));
    renderer.render(path.camera(f), settings);
    const ImageRgba radiance = renderer.readRadiance();
    if (f < 0) continue;
    ImageRgb shown{radiance.width, radiance.height, {}};
    PixelMask objects;
    for (const auto& texel : radiance.texels) {
      shown.texels.push_back(isFinite(glm::vec3(texel)) ? displayColor(glm::vec3(texel), settings.exposure, settings.toneMap) : glm::vec3(texel));
      objects.push_back(texel.a > 0.5f);
    }
    frames.shown.push_back(std::move(shown));
    frames.objects.push_back(std::move(objects));
    const FrameTimings timings = renderer.timings();
    frames.milliseconds.push_back(timings.passes.back().second);
    for (const auto& [name, milliseconds] : timings.passes)
      if (name == "upsample") frames.filterMilliseconds.push_back(milliseconds);
    frames.recomputed.push_back(renderer.recomputed().second / pixels);
  }
  return frames;
}

/// Mean absolute changes between two frames, over the pixels that both full frames cover.
void addChanges(const Frames& test, const Frames& full, std::size_t frame, glm::dvec3& sums, double& count) {
  for (std::size_t i = 0; i < full.shown[frame].texels.size(); ++i) {
    if (!full.objects[frame][i] || !full.objects[frame - 1][i]) continue;
    const glm::dvec3 t(test.shown[frame].texels[i] - test.shown[frame - 1].texels[i]), r(full.shown[frame].texels[i] - full.shown[frame - 1].texels[i]);
    for (int c = 0; c < 3; ++c) sums += glm::dvec3(std::abs(t[c]), std::abs(r[c]), std::abs(t[c] - r[c])) / 3.0;
    count += 1.0;
  }
}

VariantResult compare(const Frames& test, const Frames& full, const StudyVariant& variant, const UpsamplingSettings& study) {
  VariantResult result;
  result.variant = variant;
  double squares = 0.0, wholeSquares = 0.0, weights = 0.0, flip = 0.0, flips = 0.0, changes = 0.0;
  glm::dvec3 changed(0.0);
  result.lowestPsnr = kHighestPsnr;
  for (std::size_t f = 0; f < full.shown.size(); ++f) {
    const double rmse = rootMeanSquareError(test.shown[f], full.shown[f], full.objects[f]), whole = rootMeanSquareError(test.shown[f], full.shown[f]);
    squares += rmse * rmse;
    wholeSquares += whole * whole;
    weights += 1.0;
    result.lowestPsnr = std::min(result.lowestPsnr, psnrOf(rmse));
    if (f % static_cast<std::size_t>(study.flipEvery) == 0) {
      flip += meanOf(ldrFlip(full.shown[f], test.shown[f], {.threads = study.threads}), full.objects[f]);
      flips += 1.0;
    }
    if (f > 0) addChanges(test, full, f, changed, changes);
  }
  result.rmse = std::sqrt(squares / weights);
  result.psnr = psnrOf(result.rmse);
  result.wholePsnr = psnrOf(std::sqrt(wholeSquares / weights));
  result.flip = flip / flips;
  result.flicker = (changed.x - changed.y) / std::max(changes, 1.0);
  result.changeError = changed.z / std::max(changes, 1.0);
  for (const double share : test.recomputed) result.recomputed += share / static_cast<double>(test.recomputed.size());
  result.milliseconds = median(test.milliseconds);
  result.filterMilliseconds = median(test.filterMilliseconds);
  return result;
}

}  // namespace

std::string StudyMaterial::name() const {
  char text[64];
  std::snprintf(text, sizeof text, "%s_%.4g", model == Reflectance::blinnPhong ? "blinn" : "ggx", static_cast<double>(parameter));
  return text;
}

std::vector<StudyMaterial> standardMaterials() {
  std::vector<StudyMaterial> all;
  for (const float n : {5.0f, 50.0f, 255.0f, 1023.0f}) all.push_back({Reflectance::blinnPhong, n});
  for (const float alpha : {0.02f, 0.05f, 0.1f, 0.2f, 0.4f, 0.6f}) all.push_back({Reflectance::ggx, alpha});
  return all;
}

std::vector<MaterialResult> studyUpsampling(const BakedScene& baked, const UpsamplingSettings& study, const StudyPicture& picture,
                                            const StudyProgress& progress) {
  const Environment environment = loadEnvironment(study.environment);
  SgEnvironmentSettings prefilter;
  prefilter.threads = study.threads;
  const SgEnvironment light = prepareEnvironment(environment, prefilter);
  const std::vector<StudyVariant> variants{{"lobe", UpsampleWeights::lobe, 0.0f},
                                           {"normal", UpsampleWeights::normal, 0.0f},
                                           {"bilinear", UpsampleWeights::bilinear, 0.0f},
                                           {"lobe_recomputed", UpsampleWeights::lobe, study.recompute},
                                           {"normal_recomputed", UpsampleWeights::normal, study.recompute}};
  BakedScene named = baked;
  nameDefaultMaterial(named.scene);
  const Path path(named.scene, study);
  Renderer renderer(named);
  renderer.setEnvironment(light);
  RenderSettings settings;
  settings.width = study.size.x;
  settings.height = study.size.y;
  settings.exposure = autoExposure(environment);
  std::vector<MaterialResult> results;
  for (const auto& material : study.materials) {
    renderer.setMaterials(materialsOf(named.scene, material));
    const auto report = [&](const std::string& stage) {
      return [&progress, name = material.name() + ": " + stage](double done) { progress(name, done); };
    };
    const auto show = [&](const std::string& variant, const RenderSettings& drawn) {
      if (!picture) return;
      picture(material.name(), variant, renderer.readDisplay());
      if (drawn.upsample == 1) return;
      // Another look at the same frame: its camera and poses stand still, so the history it starts from is one frame older.
      RenderSettings view = drawn;
      view.debugView = DebugView::totalWeight;
      renderer.render(path.camera(study.frames), view);
      picture(material.name(), variant + "_weight", renderer.readDisplay());
    };
    const Frames full = draw(renderer, path, settings, study, report("full"));
    show("full", settings);
    MaterialResult result{material, median(full.milliseconds), {}};
    for (const auto& variant : variants) {
      RenderSettings upsampled = settings;
      upsampled.upsample = study.upsample;
      upsampled.upsampleWeights = variant.weights;
      upsampled.recompute = {.share = variant.recompute, .milliseconds = 0.0f};
      renderer.setEnvironment(light);  // no history is left
      const Frames test = draw(renderer, path, upsampled, study, report(variant.name));
      show(variant.name, upsampled);
      result.variants.push_back(compare(test, full, variant, study));
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace chiaro
