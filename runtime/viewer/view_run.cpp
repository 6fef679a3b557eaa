#include "runtime/viewer/view_run.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "assets/file.h"
#include "runtime/gl/context.h"
#include "runtime/render/frame_statistics.h"

namespace chiaro {
namespace {

std::string glText(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

nlohmann::ordered_json passesJson(const std::vector<PassStatistics>& passes) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& pass : passes)
    list.push_back({{"name", pass.name}, {"gpu_ms", {{"min", pass.minimum}, {"median", pass.median}, {"max", pass.maximum}}}});
  return list;
}

struct RunSeconds {
  double upload = 0.0;  ///< renderer made, environment set
  double frames = 0.0;  ///< wall clock of the counted frames
};

std::string timingsJson(const ViewOptions& options, const LoadedScene& scene, const PreparedEnvironment& environment,
                        const RenderSettings& settings, const GlFacts& facts, std::size_t gpuBytes, const RunSeconds& seconds,
                        const std::vector<PassStatistics>& passes) {
  const Scene& geometry = scene.baked.scene;
  nlohmann::ordered_json json;
  json["program"] = "chiaro-view";
  json["gl"] = {{"renderer", facts.renderer}, {"version", facts.version}, {"vendor", facts.vendor}, {"platform", facts.platform}};
  json["scene"] = scene.path.string();
  json["vertices"] = geometry.vertexCount();
  json["triangles"] = geometry.triangleCount();
  json["size"] = {options.size.x, options.size.y};
  json["supersample"] = options.supersample;
  json["environment"] = environment.name;
  json["environment_rotation_deg"] = options.rotateEnvironmentDegrees;
  json["environment_lights"] = environment.light.lights.size();
  json["lights"] = geometry.lights.size();
  json["exposure"] = settings.exposure;
  json["bytes"] = {{"file", scene.fileBytes},
                   {"gpu", gpuBytes},
                   {"transfer_per_vertex", scene.baked.transfer.bytesPerVertex(geometry.vertexCount(), scene.baked.coded ? &*scene.baked.coded : nullptr)}};
  json["seconds"] = {{"load", scene.seconds},
                     {"load_environment", environment.loadSeconds},
                     {"prepare_environment", environment.prepareSeconds},
                     {"upload", seconds.upload},
                     {"frames", seconds.frames}};
  json["frames"] = options.frames;
  json["passes"] = passesJson(passes);
  return json.dump(2) + "\n";
}

void printSummary(const ViewOptions& options, const std::vector<PassStatistics>& passes, const GlFacts& facts) {
  std::printf("%dx%d, %d frame%s", options.size.x, options.size.y, options.frames, options.frames == 1 ? "" : "s");
  if (!passes.empty()) std::printf(", %s %.2f ms", passes.back().name.c_str(), passes.back().median);
  std::printf(" on %s\n", facts.renderer.c_str());
  for (const auto& path : {options.picture, options.timings})
    if (!path.empty()) std::printf("wrote %s\n", path.c_str());
}

}  // namespace

GlFacts glFacts(const std::string& platform) { return {glText(GL_RENDERER), glText(GL_VERSION), glText(GL_VENDOR), platform}; }

RenderSettings renderSettings(const ViewOptions& options, float autoExposure) {
  RenderSettings settings;
  settings.width = options.size.x;
  settings.height = options.size.y;
  settings.supersample = options.supersample;
  settings.worldFromEnvironment = environmentRotation(options.rotateEnvironmentDegrees);
  settings.exposure = options.exposure.value_or(autoExposure);
  settings.toneMap = options.toneMap;
  settings.shadows = options.shadows;
  settings.background = options.background;
  settings.energyCompensation = options.energyCompensation;
  settings.lobes = options.lobes;
  settings.debugView = options.debugView;
  settings.upsample = options.upsample;
  settings.upsampleWeights = options.upsampleWeights;
  settings.recompute = options.recompute;
  return settings;
}

Camera viewCamera(const ViewOptions& options, const Scene& scene) {
  const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
  const Camera camera = resolveCamera(options.camera, scene, aspect);
  if (options.orbit == glm::vec2(0.0f)) return camera;
  const Bounds bounds = boundsOf(scene);
  Camera turned = orbited(camera, orbitTarget(camera, bounds), options.orbit.x, options.orbit.y);
  fitDepthRange(turned, bounds);
  return turned;
}

void runFrames(const ViewOptions& options, const LoadedScene& scene, const Camera& camera, const PreparedEnvironment& environment,
               const GlFacts& facts, const gl::DebugLog& log, const FrameHandler& afterFrame) {
  const RenderSettings settings = renderSettings(options, environment.exposure);
  if (!options.quiet) warnOfLeftOut(scene);
  RunSeconds seconds;
  double start = secondsNow();
  Renderer renderer(scene.baked);
  renderer.setEnvironment(environment.light);
  glFinish();
  seconds.upload = secondsNow() - start;

  // The first frame of a driver compiles and moves things; where frames are compared it does not count. Upsampling starts with every pixel shaded once.
  const int warmUp = settings.upsample > 1 ? settings.upsample * settings.upsample : options.frames > 1 ? 1 : 0;
  std::vector<FrameTimings> timings;
  Animator animator(scene.baked.scene, options.animation, options.moving, options.shapes);
  for (int frame = -warmUp; frame < options.frames; ++frame) {
    if (frame == 0) start = secondsNow();
    animator.apply(renderer, options.startSeconds + frame / 60.0);
    renderer.render(camera, settings);
    if (frame >= 0) timings.push_back(renderer.timings());
    if (afterFrame) afterFrame(renderer, frame);
  }
  glFinish();
  seconds.frames = secondsNow() - start;

  log.requireClean("the rendering");

  const auto passes = passStatistics(timings);
  if (!options.picture.empty()) savePicture(renderer, options.picture);
  if (!options.timings.empty())
    writeFileAtomically(options.timings, timingsJson(options, scene, environment, settings, facts, renderer.gpuBytes(), seconds, passes));
  if (!options.quiet) printSummary(options, passes, facts);
}

void savePicture(Renderer& renderer, const std::filesystem::path& path) {
  if (pictureFormat(path, path.string()) == PictureFormat::exr) writeExr(path, renderer.readRadiance());
  else writePng(path, renderer.readDisplay());
}

void viewHeadless(const ViewOptions& options) {
  const LoadedScene scene = loadForView(options.scene, options.materials, options.lights);
  const Camera camera = viewCamera(options, scene.baked.scene);
  gl::HeadlessContext context;
  const PreparedEnvironment environment = prepareForView(options.environments.front(), options.prefilter, options.threads);
  runFrames(options, scene, camera, environment, glFacts(context.platform()), context.debugLog());
}

}  // namespace chiaro
