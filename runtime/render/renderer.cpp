#include "runtime/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "assets/error.h"
#include "assets/scene/material_override.h"
#include "runtime/brdf/albedo_table.h"
#include "runtime/gl/framebuffer.h"
#include "runtime/gl/program.h"
#include "runtime/gl/query.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/frame_uniforms.h"
#include "runtime/render/gpu_environment.h"
#include "runtime/render/gpu_scene.h"
#include "runtime/render/light_visibility.h"
#include "runtime/render/pixel_budget.h"
#include "runtime/render/reflectance_textures.h"
#include "runtime/render/upsample_spec.h"
#include "runtime/render/upsampler.h"

namespace chiaro {
namespace {

constexpr std::size_t kMostBodies = 255;  // 0 for what rests; shaders/stage/upsample_guide.glsl keeps eight bits

/// Numbers of shaders/stage/tape.glsl.
enum class TapeMode { counts = 0, records = 1, answers = 2 };

/// Debug views of what a surface is are not upsampled.
bool upsamples(const RenderSettings& settings) {
  return settings.upsample > 1 && (settings.debugView == DebugView::none || settings.debugView >= DebugView::totalWeight);
}

/// Colour and depth of one size.
struct Target {
  gl::Texture color, depth;
  gl::Framebuffer framebuffer;

  Target(int width, int height, GLenum format, bool withDepth) : color(gl::Texture::make2d(format, width, height)) {
    if (withDepth) depth = gl::Texture::make2d(GL_DEPTH_COMPONENT32F, width, height);
    framebuffer = gl::Framebuffer::make({&color}, withDepth ? &depth : nullptr);
  }
  std::size_t bytes() const { return static_cast<std::size_t>(color.width()) * static_cast<std::size_t>(color.height()) * (depth ? 20 : 16); }
};

/// Bottom row first, as GL reads, to top row first.
template <class T>
std::vector<T> flipped(const std::vector<T>& rows, int width, int height) {
  std::vector<T> result(rows.size());
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>((static_cast<std::size_t>(height) - 1 - y) * w), w,
                result.begin() + static_cast<std::ptrdiff_t>(y * w));
  return result;
}

}  // namespace

struct Renderer::Impl {
  /// Body 0 is what rests; every mesh that was ever moved is one of its own.
  struct Body {
    glm::mat4 worldFromRest{1.0f};
    glm::mat4 clipFromRest{1.0f}, clipFromRestBefore{1.0f};
    std::vector<const GpuDraw*> draws;
    std::vector<VertexRange> vertices;
    gl::Buffer frame{sizeof(FrameBlock)};
  };

  GpuScene scene;
  std::vector<Light> lights;
  std::optional<GpuEnvironment> environment;
  gl::Program depthProgram, shadeProgram, backgroundProgram, resolveProgram, displayProgram;
  gl::Texture ggxTable, albedoTable, modelTable, sheenAlbedoTable, wetnessTexture;
  glm::vec4 wetnessS{0.0f}, wetnessT{0.0f};
  std::optional<MaterialFeatures> built;  // what the programs and modelTable are for
  int builtLobes = 0;
  bool builtUpsampler = false, builtShapes = false;  // the latter: for those, which upsampling alone knows
  gl::Program tapeProgram;           // made when first asked for
  std::optional<TapeMode> tapeMode;  // while a frame is recorded or replayed
  gl::Buffer tape, tapeStarts;
  gl::VertexArray noAttributes = gl::VertexArray::create();
  LightVisibility lightVisibility;
  std::unique_ptr<Target> shaded, resolved, displayed;
  std::vector<std::pair<std::string, gl::TimerQuery>> timers;  // of passes, in drawing order
  gl::TimerQuery totalTimer = gl::TimerQuery::create();
  RenderSettings last;
  bool drawn = false;
  std::vector<Body> bodies = std::vector<Body>(1);
  std::vector<std::size_t> bodyOfMesh;
  std::unique_ptr<Upsampler> upsampler;  // made when first asked for
  std::optional<PixelBudget> timedBudget;  // likewise

  explicit Impl(const BakedScene& baked) : scene(baked), lightVisibility(scene.transfer()), bodyOfMesh(scene.meshCount(), 0) {
    assignDraws();
    setLights(baked.scene.lights);
    build({});
    backgroundProgram =
        gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/background.frag"}});
    resolveProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/resolve.frag"}});
    displayProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/display.frag"}});

    ggxTable = makeGgxTexture();
    const AlbedoTable& albedo = sharedAlbedoTable();
    albedoTable = gl::Texture::make2d(GL_RGB32F, albedo.size, albedo.size);
    albedoTable.upload(0, GL_RGB, GL_FLOAT, albedo.entries.data());
  }

  MaterialFeatures features() const {
    MaterialFeatures all = scene.features();
    all.wetness = static_cast<bool>(wetnessTexture);
    return all;
  }

  void setWetness(const Wetness& wetness) {
    if (wetness.width < 1 || wetness.height < 1 || wetness.texels.size() != static_cast<std::size_t>(wetness.width) * static_cast<std::size_t>(wetness.height))
      throw Error(ExitCode::failed, "setWetness", std::to_string(wetness.texels.size()) + " texels for " + std::to_string(wetness.width) + " x " + std::to_string(wetness.height), "pass one per place");
    if (!wetnessTexture || wetnessTexture.width() != wetness.width || wetnessTexture.height() != wetness.height) {
      wetnessTexture = gl::Texture::make2d(GL_R8, wetness.width, wetness.height, 0);
      wetnessTexture.wrap(GL_REPEAT, GL_REPEAT);
    }
    wetnessTexture.upload(0, GL_RED, GL_UNSIGNED_BYTE, wetness.texels.data());
    wetnessTexture.generateMipmaps();
    wetnessS = wetness.s;
    wetnessT = wetness.t;
  }

  /// The programs and tables that the scene's materials ask for; nothing where they are there.
  void build(const RenderSettings& settings) {
    const MaterialFeatures features = this->features();
    const bool same = built == features && builtLobes == settings.lobes;
    const bool upsamplerReady = builtUpsampler && builtShapes == scene.hasShapes();
    if (same && (!upsamples(settings) || upsamplerReady)) return;
    auto defines = features.defines(kReflectanceLayers);
    if (!same) buildForward(features, settings.lobes, defines);
    builtUpsampler = upsamples(settings);
    if (!builtUpsampler) return;
    if (!upsampler) upsampler = std::make_unique<Upsampler>();
    for (auto& define : shadingDefines(settings.lobes)) defines.push_back(std::move(define));
    builtShapes = scene.hasShapes();
    upsampler->build(defines, builtShapes);
  }

  std::vector<std::string> shadingDefines(int lobes) const {
    std::vector<std::string> defines{"LOBES " + std::to_string(lobes)};
    for (auto& define : scene.transfer().defines()) defines.push_back(std::move(define));
    return defines;
  }

  void buildForward(const MaterialFeatures& features, int lobes, std::vector<std::string> defines) {
    modelTable = makeReflectanceTextures(features);
    sheenAlbedoTable = makeSheenAlbedoTexture(features);
    depthProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/depth.frag"}}, defines);
    for (auto& define : shadingDefines(lobes)) defines.push_back(std::move(define));
    shadeProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/shade.frag"}}, defines);
    built = features;
    builtLobes = lobes;
    tapeProgram = {};
  }

  void buildTape(const RenderSettings& settings) {
    build(settings);
    if (tapeProgram) return;
    auto defines = features().defines(kReflectanceLayers);
    for (auto& define : shadingDefines(settings.lobes)) defines.push_back(std::move(define));
    defines.emplace_back("TAPE 1");
    tapeProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/shade.frag"}}, defines);
  }

  void renderTaped(TapeMode mode, const Camera& camera, const RenderSettings& settings) {
    tapeProgram.set("tapeMode", static_cast<int>(mode));
    tapeProgram.set("tapeSize", glm::ivec2(settings.width, settings.height));
    tape.bindBase(GL_SHADER_STORAGE_BUFFER, 8);
    tapeStarts.bindBase(GL_SHADER_STORAGE_BUFFER, 9);
    tapeMode = mode;
    try {
      render(camera, settings);
    } catch (...) {
      tapeMode.reset();
      throw;
    }
    tapeMode.reset();
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }

  ShadingTape record(const Camera& camera, const RenderSettings& settings) {
    if (settings.supersample != 1 || settings.upsample != 1 || settings.debugView != DebugView::none)
      throw usageError("record", "a recorded frame has one shaded point a pixel and no debug view", "check supersample, upsample and debugView");
    buildTape(settings);
    ShadingTape result{.width = settings.width, .height = settings.height, .starts = {}, .questions = {}};
    const std::size_t pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
    result.starts.assign(pixels + 1, 0);
    tape = gl::Buffer(sizeof(ShadingQuestion));
    tapeStarts = gl::Buffer(result.starts);
    renderTaped(TapeMode::counts, camera, settings);
    std::uint32_t sum = 0;
    for (auto& start : result.starts = tapeStarts.read<std::uint32_t>()) start = std::exchange(sum, sum + start);
    if (sum == 0) return result;
    result.questions.resize(sum);
    tapeStarts.write(0, std::span<const std::uint32_t>(result.starts));
    tape = gl::Buffer(result.questions);
    renderTaped(TapeMode::records, camera, settings);
    result.questions = tape.read<ShadingQuestion>();
    return result;
  }

  void replay(const Camera& camera, const RenderSettings& settings, const ShadingTape& answered) {
    if (answered.width != settings.width || answered.height != settings.height || answered.questions.empty())
      throw Error(ExitCode::failed, "replay", "the tape is not of this frame", "pass what record() returned");
    buildTape(settings);
    tape = gl::Buffer(answered.questions);
    tapeStarts = gl::Buffer(answered.starts);
    renderTaped(TapeMode::answers, camera, settings);
  }

  void setLights(const std::vector<Light>& all) {
    lights.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(all.size(), kMaxPunctualLights)));
  }

  void resize(int width, int height, int supersample) {
    if (!resolved || resolved->color.width() != width || resolved->color.height() != height) {
      resolved.reset();
      resolved = std::make_unique<Target>(width, height, GL_RGBA32F, false);
    }
    const int w = width * supersample, h = height * supersample;
    if (!shaded || shaded->color.width() != w || shaded->color.height() != h) {
      shaded.reset();
      shaded = std::make_unique<Target>(w, h, GL_RGBA32F, true);
    }
  }

  void setPoses(const std::vector<glm::mat4>& poses) {
    if (poses.size() != scene.meshCount())
      throw Error(ExitCode::failed, "setPoses", std::to_string(poses.size()) + " poses for a scene with " + std::to_string(scene.meshCount()) + " meshes", "pass one per mesh");
    for (std::size_t mesh = 0; mesh < poses.size(); ++mesh) {
      if (bodyOfMesh[mesh] == 0 && poses[mesh] != glm::mat4(1.0f)) {
        if (bodies.size() == kMostBodies)
          throw Error(ExitCode::failed, "setPoses", "more than " + std::to_string(kMostBodies - 1) + " meshes move", "join meshes that move alike");
        bodyOfMesh[mesh] = bodies.size();
        const glm::mat4 clipFromRest = bodies.front().clipFromRest;
        bodies.emplace_back().clipFromRest = clipFromRest;
        assignDraws();
      }
      if (bodyOfMesh[mesh] != 0) bodies[bodyOfMesh[mesh]].worldFromRest = poses[mesh];
    }
  }

  void assignDraws() {
    for (auto& body : bodies) {
      body.draws.clear();
      body.vertices.clear();
    }
    for (const auto& one : scene.draws()) {
      Body& body = bodies[bodyOfMesh[static_cast<std::size_t>(one.mesh)]];
      body.draws.push_back(&one);
      body.vertices.push_back({one.firstVertex, one.vertexCount});
    }
  }

  void bindBody(std::size_t body) const { bodies[body].frame.bindBase(GL_UNIFORM_BUFFER, 0); }

  void prepareBodies(const Camera& camera, const RenderSettings& settings) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      Body& body = bodies[b];
      FrameBlock block = frameBlock(camera, settings, *environment, scene, lights, body.worldFromRest);
      block.wetnessS = wetnessS;
      block.wetnessT = wetnessT;
      body.clipFromRestBefore = body.clipFromRest;
      body.clipFromRest = block.clipFromWorld;
      body.frame.write(0, std::span<const FrameBlock>(&block, 1));
      bindBody(b);
      lightVisibility.update(b, block, body.vertices);
    }
    bindBody(0);
  }

  void draw(const gl::Program& program, const GpuDraw& one) const {
    program.set("materialIndex", one.material);
    program.set("firstIndex", one.firstIndex);
    scene.bindTextures(one.material);
    if (scene.material(one.material).doubleSided) glDisable(GL_CULL_FACE);
    else glEnable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, one.firstIndex, one.indexCount);
  }

  bool blended(const GpuDraw& one) const { return scene.material(one.material).alphaMode == AlphaMode::blend; }

  void drawOpaque(const gl::Program& program) const {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      bindBody(b);
      for (const auto* one : bodies[b].draws)
        if (!blended(*one)) draw(program, *one);
    }
  }

  void drawDepth() const {
    depthProgram.use();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    drawOpaque(depthProgram);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
  }

  void drawShaded() const {
    const gl::Program& program = tapeMode ? tapeProgram : shadeProgram;
    program.use();
    glDepthFunc(GL_EQUAL);
    drawOpaque(program);
  }

  /// Blended surfaces over what is behind them, farthest primitive first.
  void drawBlended(const Camera& camera) const {
    struct Blended {
      const GpuDraw* draw;
      std::size_t body;
      float distance;
    };
    std::vector<Blended> order;
    const glm::vec3 eye(camera.worldFromCamera[3]);
    for (const auto& one : scene.draws()) {
      if (!blended(one)) continue;
      const std::size_t body = bodyOfMesh[static_cast<std::size_t>(one.mesh)];
      order.push_back({&one, body, glm::distance(glm::vec3(bodies[body].worldFromRest * glm::vec4(one.center, 1.0f)), eye)});
    }
    if (order.empty()) return;
    std::stable_sort(order.begin(), order.end(), [](const Blended& a, const Blended& b) { return a.distance > b.distance; });
    shadeProgram.use();
    glDepthFunc(GL_LESS);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const auto& one : order) {
      bindBody(one.body);
      draw(shadeProgram, *one.draw);
    }
    glDisable(GL_BLEND);
  }

  void fullscreen(const gl::Program& program) const {
    program.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  /// Passes of another name than in the last frame are new ones.
  void timed(std::size_t pass, const char* name, const auto& body) {
    if (timers.size() <= pass) timers.resize(pass + 1);
    if (timers[pass].first != name) timers[pass] = {name, gl::TimerQuery::create()};
    timers[pass].second.begin();
    body();
    timers[pass].second.end();
  }

  void clear() const {
    const float black[4] = {0, 0, 0, 0}, farthest = 1.0f;
    glClearNamedFramebufferfv(shaded->framebuffer.id(), GL_COLOR, 0, black);
    glClearNamedFramebufferfv(shaded->framebuffer.id(), GL_DEPTH, 0, &farthest);
  }

  static void dataPass() {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
  }

  std::size_t renderInFull() {
    if (upsampler) upsampler->forget();
    timed(0, "depth", [&] { drawDepth(); });
    timed(1, "shade", [&] { drawShaded(); });
    return 2;
  }

  /// As many pixels as the user allows.
  unsigned recomputeBudget(const RenderSettings& settings) {
    const double pixels = static_cast<double>(shaded->color.width()) * shaded->color.height();
    const double milliseconds = static_cast<double>(settings.recompute.milliseconds);
    if (!(milliseconds > 0.0)) return static_cast<unsigned>(pixels * static_cast<double>(std::clamp(settings.recompute.share, 0.0f, 1.0f)));
    if (!timedBudget) timedBudget.emplace();
    return timedBudget->pixelsFor(milliseconds, pixels);
  }

  void recompute(const RenderSettings& settings, int bodyCount, const std::function<void(int)>& bind) {
    const unsigned pixels = recomputeBudget(settings);
    const bool byTime = settings.recompute.milliseconds > 0.0f;
    if (byTime) timedBudget->begin();
    upsampler->recompute(bodyCount, bind, pixels);
    if (byTime) timedBudget->end(upsampler->listed(), Upsampler::kListedOffset);
  }

  std::size_t renderUpsampled(const Camera& camera, const RenderSettings& settings) {
    upsampler->begin(shaded->color, shaded->depth, camera, settings, environment->meanRadiance());
    const auto bind = [this](int body) { bindBody(static_cast<std::size_t>(body)); };
    const int count = static_cast<int>(bodies.size());
    timed(0, "surfaces", [&] {
      upsampler->bindSurfaces();
      glDepthFunc(GL_LEQUAL);  // of two at one depth the later, as where depth is drawn first
      upsampler->surfaceProgram().use();
      for (int b = 0; b < count; ++b) {
        const Body& body = bodies[static_cast<std::size_t>(b)];
        bind(b);
        upsampler->setBody(b, body.clipFromRestBefore);
        for (const auto* one : body.draws)
          if (!blended(*one)) draw(upsampler->surfaceProgram(), *one);
      }
    });
    glDepthMask(GL_FALSE);
    dataPass();
    timed(1, "estimate", [&] { upsampler->estimate(count, bind, shaded->depth); });
    timed(2, "coarse shade", [&] { upsampler->shade(count, bind); });
    timed(3, "upsample", [&] { upsampler->filter(); });
    timed(4, "recompute", [&] { recompute(settings, count, bind); });
    timed(5, "compose", [&] { upsampler->compose(); });
    bindBody(0);
    shaded->framebuffer.bind();
    glEnable(GL_DEPTH_TEST);
    return 6;
  }

  void render(const Camera& camera, const RenderSettings& settings) {
    if (!environment) throw Error(ExitCode::failed, "render", "no environment was set", "call setEnvironment first");
    build(settings);
    resize(settings.width, settings.height, settings.supersample);

    totalTimer.begin();
    scene.bindBuffers();
    prepareBodies(camera, settings);
    environment->bindTextures();
    ggxTable.bind(9);
    albedoTable.bind(10);
    if (modelTable) modelTable.bind(16);
    if (sheenAlbedoTable) sheenAlbedoTable.bind(23);
    if (wetnessTexture) wetnessTexture.bind(24);
    noAttributes.bind();
    shaded->framebuffer.bind();
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDepthRange(0.0, 1.0);
    glEnable(GL_DEPTH_TEST);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDepthMask(GL_TRUE);
    clear();

    std::size_t pass = upsamples(settings) ? renderUpsampled(camera, settings) : renderInFull();
    timed(pass++, "background", [&] {
      if (!settings.background || settings.debugView != DebugView::none) return;
      bindBody(0);
      glDisable(GL_CULL_FACE);
      glDepthFunc(GL_LEQUAL);
      fullscreen(backgroundProgram);
    });
    timed(pass++, "blended", [&] {
      if (settings.debugView < DebugView::totalWeight) drawBlended(camera);
    });
    dataPass();
    timed(pass++, "resolve", [&] {
      resolved->framebuffer.bind();
      shaded->color.bind(0);
      resolveProgram.set("supersample", settings.supersample);
      fullscreen(resolveProgram);
    });
    totalTimer.end();
    scene.keepShapes();
    timers.resize(pass);
    last = settings;
    drawn = true;
  }

  void display(GLuint framebuffer, int width, int height) const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_FRAMEBUFFER_SRGB);
    noAttributes.bind();
    resolved->color.bind(0);
    // Debug views are data, not light.
    const bool light = last.debugView == DebugView::none;
    displayProgram.set("exposure", light ? last.exposure : 1.0f);
    displayProgram.set("toneMap", static_cast<int>(light ? last.toneMap : ToneMap::clamp));
    fullscreen(displayProgram);
  }

  void requireFrame() const {
    if (!drawn) throw Error(ExitCode::failed, "renderer", "no frame was rendered yet", "call render first");
  }
};

std::string leftOut(const Scene& scene) {
  if (scene.lights.size() <= kMaxPunctualLights) return {};
  return std::to_string(scene.lights.size()) + " punctual lights: only the first " + std::to_string(kMaxPunctualLights) + " are drawn";
}

Renderer::Renderer(const BakedScene& baked) : impl_(std::make_unique<Impl>(baked)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::setEnvironment(const SgEnvironment& environment) {
  impl_->environment.emplace(environment);
  if (impl_->upsampler) impl_->upsampler->forget();
}
void Renderer::setLights(const std::vector<Light>& lights) { impl_->setLights(lights); }
void Renderer::setMaterials(const std::vector<Material>& materials) { impl_->scene.setMaterials(materials); }

void Renderer::setWetness(const Wetness& wetness) { impl_->setWetness(wetness); }

void Renderer::setShapes(const std::vector<PrimitiveShape>& shapes) {
  for (const auto& shape : shapes) impl_->scene.setShape(shape.primitive, shape.positions, shape.normals);
}

void Renderer::setPoses(const std::vector<glm::mat4>& worldFromBaked) { impl_->setPoses(worldFromBaked); }

namespace {

void requireDrawable(const RenderSettings& settings) {
  if (settings.width < 1 || settings.height < 1 || settings.supersample < 1 || settings.supersample > 8)
    throw usageError("size", "a picture needs at least one pixel and 1 to 8 samples a side", "check width, height and supersample");
  requireLobes(settings.lobes, "lobes");
  requireUpsample(settings.upsample, "upsample");
}

}  // namespace

void Renderer::render(const Camera& camera, const RenderSettings& settings) {
  requireDrawable(settings);
  impl_->render(camera, settings);
}

ShadingTape Renderer::record(const Camera& camera, const RenderSettings& settings) {
  requireDrawable(settings);
  return impl_->record(camera, settings);
}

void Renderer::replay(const Camera& camera, const RenderSettings& settings, const ShadingTape& answered) {
  requireDrawable(settings);
  impl_->replay(camera, settings, answered);
}

void Renderer::present(int windowWidth, int windowHeight) {
  impl_->requireFrame();
  impl_->display(0, windowWidth, windowHeight);
}

ImageRgba Renderer::readRadiance() {
  impl_->requireFrame();
  const int width = impl_->resolved->color.width(), height = impl_->resolved->color.height();
  std::vector<glm::vec4> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  impl_->resolved->color.download(0, GL_RGBA, GL_FLOAT, texels.data(), texels.size() * sizeof(glm::vec4));
  return {width, height, flipped(texels, width, height)};
}

Image8 Renderer::readDisplay() {
  impl_->requireFrame();
  const int width = impl_->resolved->color.width(), height = impl_->resolved->color.height();
  impl_->displayed = std::make_unique<Target>(width, height, GL_RGBA8, false);
  impl_->display(impl_->displayed->framebuffer.id(), width, height);
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  impl_->displayed->color.download(0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data(), texels.size() * sizeof(std::uint32_t));
  texels = flipped(texels, width, height);
  Image8 image{width, height, std::vector<std::uint8_t>(texels.size() * 4)};
  std::copy_n(reinterpret_cast<const std::uint8_t*>(texels.data()), image.texels.size(), image.texels.begin());
  return image;
}

std::pair<unsigned, unsigned> Renderer::recomputed() const {
  impl_->requireFrame();
  return upsamples(impl_->last) ? impl_->upsampler->recomputed() : std::pair<unsigned, unsigned>{0, 0};
}

FrameTimings Renderer::timings() {
  impl_->requireFrame();
  FrameTimings timings;
  for (const auto& [name, timer] : impl_->timers) timings.passes.emplace_back(name, 1e3 * timer.seconds());
  timings.passes.emplace_back("total", 1e3 * impl_->totalTimer.seconds());
  return timings;
}

std::size_t Renderer::gpuBytes() const {
  std::size_t bytes = impl_->scene.bytes() + (impl_->environment ? impl_->environment->bytes() : 0) + (impl_->upsampler ? impl_->upsampler->bytes() : 0);
  for (const auto* target : {&impl_->shaded, &impl_->resolved, &impl_->displayed})
    if (*target) bytes += (*target)->bytes();
  return bytes;
}

}  // namespace chiaro
