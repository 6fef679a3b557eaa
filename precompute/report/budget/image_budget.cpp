#include "precompute/report/budget/image_budget.h"

#include <algorithm>
#include <cmath>

#include "assets/builtin/environment.h"
#include "assets/error.h"
#include "precompute/parallel.h"
#include "precompute/reference/reference.h"
#include "precompute/reference/sampling.h"
#include "precompute/reference/view_ray.h"
#include "precompute/report/budget/traced_light.h"
#include "precompute/report/metrics/perceptual.h"
#include "runtime/environment/sg_environment.h"
#include "runtime/gl/context.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/renderer.h"

namespace chiaro {
namespace {

/// Of its distance: a hit is the renderer's own point where it is this near.
constexpr double kSamePoint = 1e-3;

/// When a question's answer is first used.
enum class Exact { visibility = 1, environment = 2, product = 3 };

Exact exactFrom(ShadingAsks asks) {
  switch (asks) {
    case ShadingAsks::mean: return Exact::environment;
    case ShadingAsks::lobe:
    case ShadingAsks::irradiance:
    case ShadingAsks::rest: return Exact::product;
    default: return Exact::visibility;
  }
}

BakedScene studied(const BakedScene& baked, const MaterialOverride& materials) {
  BakedScene scene = baked;
  nameDefaultMaterial(scene.scene);
  overrideMaterials(scene.scene, materials);
  scene.scene.lights.clear();
  return scene;
}

std::optional<glm::dvec3> answerOf(const ShadingQuestion& question, TracedLight& light) {
  const auto sharpness = static_cast<double>(question.sharpness);
  const auto gray = [](std::optional<double> share) { return share ? std::optional(glm::dvec3(*share)) : std::nullopt; };
  switch (question.asks()) {
    case ShadingAsks::share: return gray(light.share(question.axis, sharpness));
    case ShadingAsks::fixedShare: return gray(light.cosineShare(question.axis, sharpness));
    case ShadingAsks::mean: return light.mean(question.axis, sharpness);
    case ShadingAsks::lobe: return light.lobe(question.axis, sharpness);
    case ShadingAsks::irradiance: return light.irradiance();
    case ShadingAsks::rest: return light.rest(question.axis, sharpness);
    default: return std::nullopt;
  }
}

ImageRgba blank(const ImageRgba& like) { return {.width = like.width, .height = like.height, .texels = std::vector<glm::vec4>(like.texels.size(), glm::vec4(0.0f))}; }

/// What rays say of the renderer's pixels.
struct Traced {
  ShadingTape tape;                                 ///< with answers; where there is none the code is below 0
  ImageRgba gaussian;                               ///< drawn from the distribution's Gaussians
  ImageRgba reflectance;                            ///< drawn from the exact reflectance of the renderer's surfaces
  ReferenceHalves exact;                            ///< and of those that rays read
  std::vector<std::uint8_t> compared;               ///< by pixel
};

/// The surface a ray met, with the renderer's filtered textures in it.
reference::Surface asDrawn(const reference::Surface& met, const ShadedSurface& drawn) {
  reference::Surface surface = met;
  const auto n = glm::normalize(glm::dvec3(drawn.n)), t = glm::normalize(glm::dvec3(drawn.t) - n * glm::dot(n, glm::dvec3(drawn.t)));
  surface.worldFromTangent = glm::dmat3(t, glm::cross(n, t), n);
  surface.brdf.alphaX = static_cast<double>(drawn.alphaT);
  surface.brdf.alphaY = static_cast<double>(drawn.alphaB);
  surface.brdf.f0 = glm::dvec3(drawn.f0);
  surface.brdf.f90 = glm::dvec3(static_cast<double>(drawn.f90));
  surface.brdf.diffuse = glm::dvec3(drawn.diffuse);
  surface.brdf.coatNormal = met.worldFromTangent * met.brdf.coatNormal * surface.worldFromTangent;
  surface.emission = glm::dvec3(drawn.emission);
  return surface;
}

class PixelTracer {
 public:
  PixelTracer(const Scene& scene, const Camera& camera, const Environment& environment, const std::vector<SgLight>& lights, const ImageBudgetSettings& settings)
      : camera_(camera), lights_(lights), settings_(settings), rays_(scene), surfaces_(scene), environment_(environment, glm::mat3(1.0f)) {}

  /// Fills pixel (x, y) of `traced`, whose tape is as recorded.
  void trace(int x, int y, Traced& traced) const {
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(settings_.size.x) + static_cast<std::size_t>(x);
    const auto first = traced.tape.starts[pixel], last = traced.tape.starts[pixel + 1];
    const auto ray = reference::viewRay(camera_, static_cast<double>(settings_.size.x) / settings_.size.y, (glm::dvec2(x, y) + 0.5) / glm::dvec2(settings_.size));
    RayHit hit;
    if (first == last || !nearestFacing(ray, hit)) return;
    const glm::dvec3 wo = -glm::normalize(glm::dvec3(ray.direction));
    const auto surface = surfaces_.at(hit, wo);
    const auto shaded = shadedSurface(&traced.tape.questions[first]);
    if (surface.opacity < 1.0 || !(glm::distance(glm::dvec3(shaded.position), surface.position) <= kSamePoint * static_cast<double>(hit.distance))) return;
    const auto drawn = asDrawn(surface, shaded);

    const auto seed = reference::hashWords(reference::hashWords(settings_.seed + 7u, static_cast<std::uint32_t>(x)), static_cast<std::uint32_t>(y));
    const TracedLightSettings samples{.raysPerLobe = settings_.raysPerLobe, .lightSamples = settings_.samples, .seed = seed};
    TracedLight light(drawn, rays_, environment_, lights_, samples);
    for (auto q = first + kSurfaceNotes; q < last; ++q) {
      auto& question = traced.tape.questions[q];
      const auto answer = answerOf(question, light);
      if (answer) question.answer = glm::vec3(*answer);
      else question.code = -1.0f;
    }
    const auto texel = [](glm::dvec3 radiance) { return glm::vec4(glm::vec3(radiance), 1.0f); };
    const auto one = light.reflected(wo, 0), other = light.reflected(wo, 1);
    traced.gaussian.texels[pixel] = texel(drawn.emission + 0.5 * (one.gaussian + other.gaussian));
    traced.reflectance.texels[pixel] = texel(drawn.emission + 0.5 * (one.exact + other.exact));
    TracedLight own(surface, rays_, environment_, lights_, samples);
    traced.exact.first.texels[pixel] = texel(surface.emission + own.reflected(wo, 0).exact);
    traced.exact.second.texels[pixel] = texel(surface.emission + own.reflected(wo, 1).exact);
    traced.compared[pixel] = 1;
  }

 private:
  bool nearestFacing(const reference::ViewRay& ray, RayHit& hit) const {
    for (float near = ray.near; rays_.intersect(ray.origin, ray.direction, near, ray.far, hit);
         near = std::max(hit.distance + rays_.surfaceOffset(ray.origin + hit.distance * ray.direction), std::nextafter(hit.distance, ray.far)))
      if (!surfaces_.isCulled(hit, ray.direction)) return true;
    return false;
  }

  Camera camera_;
  const std::vector<SgLight>& lights_;
  const ImageBudgetSettings& settings_;
  RayScene rays_;
  reference::SurfaceReader surfaces_;
  reference::EnvironmentSampler environment_;
};

ShadingTape answeredUpTo(const ShadingTape& traced, Exact stage) {
  ShadingTape tape = traced;
  for (auto& question : tape.questions) {
    const bool used = question.code > 0.0f && exactFrom(question.asks()) <= stage;
    question.code = used ? 1.0f : 0.0f;
  }
  return tape;
}

/// Root mean square over the channels of the pixels that `mask` covers.
double linearDifference(const ImageRgba& a, const ImageRgba& b, const ImageRgba& mask, float exposure) {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < mask.texels.size(); ++i) {
    if (!(mask.texels[i].a > 0.5f)) continue;
    const glm::dvec3 difference = static_cast<double>(exposure) * (glm::dvec3(a.texels[i]) - glm::dvec3(b.texels[i]));
    squares += glm::dot(difference, difference);
    count += 3.0;
  }
  return std::sqrt(squares / count);
}

ImageError errorOf(const ImageRgba& picture, const ReferenceHalves& halves, const ImageRgba& reference, const DisplaySettings& display, int threads) {
  ImageError error;
  error.rmse = comparePictures(picture, halves, display).rmse;
  error.psnr = psnrOf(error.rmse);
  error.linearRmse = linearDifference(picture, reference, reference, display.exposure);
  error.linearPsnr = psnrOf(error.linearRmse);
  error.flip = comparePerceptually(picture, reference, display, threads).flip;
  return error;
}

/// Of the mean of two halves.
ImageError noiseOf(const ReferenceHalves& halves, const ImageRgba& mask, const DisplaySettings& display) {
  ImageRgba first = halves.first, second = halves.second;
  for (std::size_t i = 0; i < mask.texels.size(); ++i) first.texels[i].a = second.texels[i].a = mask.texels[i].a;
  return {.rmse = 0.5 * comparePictures(first, {second, second}, display).rmse, .linearRmse = 0.5 * linearDifference(first, second, mask, display.exposure)};
}

ReferenceHalves drawReference(const Scene& scene, const Environment& environment, const Camera& camera, const ImageBudgetSettings& settings, const ProgressHandler& progress) {
  ReferenceSettings reference{.width = settings.size.x, .height = settings.size.y, .samplesPerPixel = settings.samples / 2, .background = false, .threads = settings.threads};
  ReferenceHalves halves;
  for (auto* half : {&halves.first, &halves.second}) {
    *half = renderReference(scene, environment, camera, reference, progress).radiance;
    ++reference.seed;
  }
  return halves;
}

}  // namespace

double ImageBudget::leftOverNoise() const { return stages.back().error.rmse / std::hypot(referenceNoise.rmse, exactNoise.rmse); }

ImageBudget imageBudget(const BakedScene& baked, const ImageBudgetSettings& settings, const ProgressHandler& progress) {
  const BakedScene scene = studied(baked, settings.materials);
  const auto environment = loadEnvironment(settings.environment);
  SgEnvironmentSettings prefilter;
  prefilter.threads = settings.threads;
  const auto prefiltered = prepareEnvironment(environment, prefilter);
  ImageBudget budget;
  budget.camera = resolveCamera(settings.camera, scene.scene, static_cast<float>(settings.size.x) / static_cast<float>(settings.size.y));
  budget.display.exposure = autoExposure(environment);

  gl::HeadlessContext context;
  budget.glRenderer = context.renderer();
  Renderer renderer(scene);
  renderer.setEnvironment(prefiltered);
  RenderSettings draw;
  draw.width = settings.size.x;
  draw.height = settings.size.y;
  draw.background = false;
  const auto stage = [&](const std::string& what, const std::string& cause, ImageRgba picture) {
    budget.stages.push_back({.what = what, .cause = cause, .picture = std::move(picture), .error = {}, .change = 0.0});
  };
  if (settings.upsample > 1) {
    RenderSettings upsampled = draw;
    upsampled.upsample = settings.upsample;
    // Every pixel of a cell is shaded once, and once more with the history of all.
    for (int frame = 0; frame < 2 * settings.upsample * settings.upsample; ++frame) renderer.render(budget.camera, upsampled);
    stage("as drawn, upsampled", "upsampling", renderer.readRadiance());
  }
  renderer.render(budget.camera, draw);
  stage(settings.upsample > 1 ? "every pixel shaded" : "as drawn", "stored visibility", renderer.readRadiance());

  Traced traced{.tape = renderer.record(budget.camera, draw), .gaussian = blank(budget.stages.back().picture), .reflectance = {}, .exact = {}, .compared = {}};
  if (traced.tape.questions.empty()) throw Error(ExitCode::failed, "report", "no pixel shows the scene", "give a --camera that looks at it");
  traced.reflectance = traced.gaussian;
  traced.exact = {traced.gaussian, traced.gaussian};
  traced.compared.assign(traced.gaussian.texels.size(), 0);
  auto lights = prefiltered.lights;
  lights.resize(std::min<std::size_t>(lights.size(), kMaxSgLights));
  const PixelTracer tracer(scene.scene, budget.camera, environment, lights, settings);
  const std::function<void(double)> shown = [&](double done) {
    if (progress) progress("exact light", done);
  };
  StepCounter steps(static_cast<std::size_t>(settings.size.y), shown);
  parallelBlocks(settings.threads, static_cast<std::size_t>(settings.size.y), [&](std::size_t y) {
    for (int x = 0; x < settings.size.x; ++x) tracer.trace(x, static_cast<int>(y), traced);
    steps.add();
  });
  for (std::size_t pixel = 0; pixel < traced.compared.size(); ++pixel)
    if (traced.compared[pixel] == 0)
      for (auto q = traced.tape.starts[pixel]; q < traced.tape.starts[pixel + 1]; ++q) traced.tape.questions[q].code = -1.0f;

  for (const auto& [exact, what, cause] : {std::tuple{Exact::visibility, "visible shares traced", "environment prefilter"},
                                           std::tuple{Exact::environment, "environment integrated over lobes", "light and visibility apart"},
                                           std::tuple{Exact::product, "light times visibility over lobes", "lobes of light directions"}}) {
    renderer.replay(budget.camera, draw, answeredUpTo(traced.tape, exact));
    stage(what, cause, renderer.readRadiance());
  }
  context.debugLog().requireClean("the rendering");
  stage("Gaussians at half vectors", "Gaussians of the distribution", std::move(traced.gaussian));
  stage("exact reflectance", "texture filtering", std::move(traced.reflectance));
  stage("surfaces as rays read them", "left: noise", meanOf(traced.exact));

  auto halves = drawReference(scene.scene, environment, budget.camera, settings, progress);
  const auto& drawn = budget.stages.front().picture;
  for (std::size_t pixel = 0; pixel < traced.compared.size(); ++pixel) {
    const bool covered = drawn.texels[pixel].a > 0.5f || halves.first.texels[pixel].a > 0.5f, compared = traced.compared[pixel] != 0;
    budget.pixels += compared;
    budget.leftOut += covered && !compared;
    halves.first.texels[pixel].a = halves.second.texels[pixel].a = compared ? 1.0f : 0.0f;
  }
  if (budget.pixels == 0) throw Error(ExitCode::failed, "report", "no opaque pixel shows the scene", "give a --camera that looks at it");
  budget.reference = meanOf(halves);
  budget.referenceNoise = noiseOf(halves, budget.reference, budget.display);
  budget.exactNoise = noiseOf(traced.exact, budget.reference, budget.display);
  for (std::size_t i = 0; i < budget.stages.size(); ++i) {
    auto& one = budget.stages[i];
    one.error = errorOf(one.picture, halves, budget.reference, budget.display, settings.threads);
    ImageRgba next = i + 1 < budget.stages.size() ? budget.stages[i + 1].picture : budget.reference;
    for (std::size_t pixel = 0; pixel < next.texels.size(); ++pixel) next.texels[pixel].a = budget.reference.texels[pixel].a;
    one.change = comparePictures(one.picture, {next, next}, budget.display).rmse;
  }
  return budget;
}

}  // namespace chiaro
