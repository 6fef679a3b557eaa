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
#include "runtime/render/frame_statistics.h"
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
    m.sheenColorFactor = m.emissiveFactor = glm::vec3(0.0f);
    m.reflectanceF0.reset();
    m.alphaMode = AlphaMode::opaque;
    m.reflectanceWidth = glm::vec2(material.parameter);
  }
  return scene.materials;
}

constexpr double kStartDegrees = 80.0;

/// Camera and poses of a frame; negative ones come before those that count.
class Path {
 public:
  Path(const Scene& scene, const UpsamplingSettings& settings) : settings_(settings), bounds_(boundsOf(scene)), rest_(scene.meshNames.size(), glm::mat4(1.0f)) {
    const float aspect = static_cast<float>(settings.size.x) / static_cast<float>(settings.size.y);
    start_ = resolveCamera(settings.camera, scene, aspect);
    if (!settings.moving.empty()) mesh_.emplace(scene, settings.moving);
    if (settings.shapes.frames.empty()) return;
    shapes_.emplace(scene, settings.shapes);
    bounds_.include(shapes_->bounds().lower);
    bounds_.include(shapes_->bounds().upper);
  }

  Camera camera(int frame) const {
    Camera turned = orbited(start_, orbitTarget(start_, bounds_), radians(static_cast<double>(settings_.turnDegrees) * frame), 0.0f);
    fitDepthRange(turned, bounds_);
    return turned;
  }

  void pose(Renderer& renderer, int frame) const {
    renderer.setPoses(poses(frame));
    if (shapes_) renderer.setShapes(shapes_->at(frame));
  }

 private:
  std::vector<glm::mat4> poses(int frame) const {
    // Aside from where it was baked, where a pose would be no movement.
    return mesh_ ? mesh_->poses(kStartDegrees + static_cast<double>(settings_.movingDegrees) * frame) : rest_;
  }

  const UpsamplingSettings& settings_;
  Bounds bounds_;
  Camera start_;
  std::vector<glm::mat4> rest_;
  std::optional<MovingMesh> mesh_;
  std::optional<VertexCache> shapes_;
};

/// Tone-mapped and encoded.
struct Shown {
  ImageRgb picture;
  PixelMask objects;
};

Shown shownOf(const ImageRgba& radiance, const RenderSettings& settings) {
  Shown shown{{radiance.width, radiance.height, {}}, {}};
  for (const auto& texel : radiance.texels) {
    shown.picture.texels.push_back(isFinite(glm::vec3(texel)) ? displayColor(glm::vec3(texel), settings.exposure, settings.toneMap) : glm::vec3(texel));
    shown.objects.push_back(texel.a > 0.5f);
  }
  return shown;
}

struct Costs {
  std::vector<FrameTimings> timings;
  std::vector<double> recomputed;  // share of all pixels
};

/// GPU milliseconds; 0 for a pass that no frame has.
double medianOf(const Costs& costs, const std::string& pass) {
  for (const auto& one : passStatistics(costs.timings))
    if (one.name == pass) return one.median;
  return 0.0;
}

/// Draws the frames that do not count and those that do, and hands out the latter as they come.
Costs draw(Renderer& renderer, const Path& path, const RenderSettings& settings, const UpsamplingSettings& study, const std::function<void(double)>& progress,
           const std::function<void(std::size_t, Shown)>& take) {
  Costs costs;
  const int warmUp = settings.upsample > 1 ? study.warmUp : 1;  // a first frame compiles and moves things
  const double pixels = static_cast<double>(study.size.x) * study.size.y;
  for (int f = -warmUp; f < study.frames; ++f) {
    progress(static_cast<double>(f + warmUp) / (study.frames + warmUp));
    path.pose(renderer, f);
    renderer.render(path.camera(f), settings);
    if (f < 0) continue;
    take(static_cast<std::size_t>(f), shownOf(renderer.readRadiance(), settings));
    costs.timings.push_back(renderer.timings());
    costs.recomputed.push_back(renderer.recomputed().second / pixels);
  }
  return costs;
}

/// A variant beside the full frames, frame by frame.
class Comparison {
 public:
  Comparison(const std::vector<Shown>& full, const UpsamplingSettings& study) : full_(full), study_(study) {}

  void add(std::size_t frame, Shown test) {
    const Shown& full = full_[frame];
    const double rmse = rootMeanSquareError(test.picture, full.picture, full.objects), whole = rootMeanSquareError(test.picture, full.picture);
    squares_ += rmse * rmse;
    wholeSquares_ += whole * whole;
    lowest_ = std::min(lowest_, psnrOf(rmse));
    if (frame % static_cast<std::size_t>(flipEvery(study_)) == 0) {
      flip_ += meanOf(ldrFlip(full.picture, test.picture, {.threads = study_.threads}), full.objects);
      flips_ += 1.0;
    }
    if (frame > 0) addChanges(test.picture, frame);
    before_ = std::move(test.picture);
  }

  VariantResult result(const StudyVariant& variant, const Costs& costs) const {
    VariantResult result;
    const auto frames = static_cast<double>(full_.size());
    result.variant = variant;
    result.rmse = std::sqrt(squares_ / frames);
    result.psnr = psnrOf(result.rmse);
    result.wholePsnr = psnrOf(std::sqrt(wholeSquares_ / frames));
    result.lowestPsnr = lowest_;
    result.flip = flip_ / flips_;
    result.flicker = (changes_.x - changes_.y) / std::max(changed_, 1.0);
    result.changeError = changes_.z / std::max(changed_, 1.0);
    double covered = 0.0, all = 0.0;
    for (const auto& full : full_) {
      covered += static_cast<double>(std::count(full.objects.begin(), full.objects.end(), true));
      all += static_cast<double>(full.objects.size());
    }
    for (const double share : costs.recomputed) result.recomputed += share / frames;
    result.recomputedOfObjects = result.recomputed * all / std::max(covered, 1.0);
    result.milliseconds = medianOf(costs, "total");
    result.filterMilliseconds = medianOf(costs, "upsample");
    return result;
  }

 private:
  /// Mean absolute changes between two frames, over the pixels that both full frames cover.
  void addChanges(const ImageRgb& test, std::size_t frame) {
    const Shown &now = full_[frame], &then = full_[frame - 1];
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
      if (!now.objects[i] || !then.objects[i]) continue;
      const glm::dvec3 t(test.texels[i] - before_.texels[i]), r(now.picture.texels[i] - then.picture.texels[i]);
      for (int c = 0; c < 3; ++c) changes_ += glm::dvec3(std::abs(t[c]), std::abs(r[c]), std::abs(t[c] - r[c])) / 3.0;
      changed_ += 1.0;
    }
  }

  const std::vector<Shown>& full_;
  const UpsamplingSettings& study_;
  ImageRgb before_;
  double squares_ = 0.0, wholeSquares_ = 0.0, lowest_ = kHighestPsnr, flip_ = 0.0, flips_ = 0.0, changed_ = 0.0;
  glm::dvec3 changes_{0.0};  // of the variant, of the full frames, of their difference
};

}  // namespace

std::string StudyMaterial::name() const {
  char text[64];
  std::snprintf(text, sizeof text, "%s_%.6g", reflectanceNames()[static_cast<std::size_t>(model)].c_str(), static_cast<double>(parameter));
  return text;
}

int flipEvery(const UpsamplingSettings& settings) { return std::max(1, settings.frames / 8); }

std::vector<StudyMaterial> standardMaterials() {
  std::vector<StudyMaterial> all;
  for (const float n : {5.0f, 50.0f, 255.0f, 1023.0f}) all.push_back({Reflectance::blinnPhong, n});
  for (const float alpha : {0.02f, 0.05f, 0.1f, 0.2f, 0.4f, 0.6f}) all.push_back({Reflectance::ggx, alpha});
  return all;
}

std::vector<StudyVariant> standardVariants() {
  return {{"lobe", UpsampleWeights::lobe, true, false},
          {"normal", UpsampleWeights::normal, false, false},
          {"bilinear", UpsampleWeights::bilinear, false, false},
          {"lobe_recomputed", UpsampleWeights::lobe, true, true},
          {"normal_recomputed", UpsampleWeights::normal, false, true}};
}

std::vector<StudyVariant> allVariants() {
  auto all = standardVariants();
  all.push_back({"lobe_plain", UpsampleWeights::lobe, false, false});
  all.push_back({"normal_estimated", UpsampleWeights::normal, true, false});
  all.push_back({"bilinear_estimated", UpsampleWeights::bilinear, true, false});
  all.push_back({"normal_estimated_recomputed", UpsampleWeights::normal, true, true});
  return all;
}

std::vector<MaterialResult> studyUpsampling(const BakedScene& baked, const UpsamplingSettings& study, const StudyPicture& picture,
                                            const StudyProgress& progress) {
  const Environment environment = loadEnvironment(study.environment);
  SgEnvironmentSettings prefilter;
  prefilter.threads = study.threads;
  const SgEnvironment light = prepareEnvironment(environment, prefilter);
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
      // The last frame once more: its history is that frame itself.
      RenderSettings view = drawn;
      view.debugView = DebugView::totalWeight;
      renderer.render(path.camera(study.frames - 1), view);
      picture(material.name(), variant + "_weight", renderer.readDisplay());
    };
    std::vector<Shown> full;
    const Costs fullCosts = draw(renderer, path, settings, study, report("full"), [&](std::size_t, Shown shown) { full.push_back(std::move(shown)); });
    show("full", settings);
    MaterialResult result{material, medianOf(fullCosts, "total"), {}};
    for (const auto& variant : study.variants) {
      RenderSettings upsampled = settings;
      upsampled.upsample = study.upsample;
      upsampled.upsampleWeights = variant.weights;
      upsampled.upsampleEstimate = variant.estimate;
      upsampled.recompute = {.share = variant.recomputes ? study.recompute : 0.0f, .milliseconds = 0.0f};
      renderer.setEnvironment(light);  // no history is left
      Comparison comparison(full, study);
      const Costs costs = draw(renderer, path, upsampled, study, report(variant.name), [&](std::size_t f, Shown shown) { comparison.add(f, std::move(shown)); });
      show(variant.name, upsampled);
      result.variants.push_back(comparison.result(variant, costs));
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace chiaro
