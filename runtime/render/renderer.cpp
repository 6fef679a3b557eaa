#include "runtime/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "assets/error.h"
#include "assets/scene/material_override.h"
#include "runtime/brdf/specular_table.h"
#include "runtime/gl/framebuffer.h"
#include "runtime/gl/program.h"
#include "runtime/gl/query.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/gpu_environment.h"
#include "runtime/render/gpu_scene.h"
#include "runtime/render/reflectance_textures.h"

namespace chiaro {
namespace {

constexpr unsigned kFlagShadows = 1, kFlagEnergyCompensation = 2;
const std::vector<std::string> kPasses{"depth", "shade", "background", "blended", "resolve"};

glm::mat4 projectionOf(const Camera& camera, float aspect) {
  if (camera.perspective) return glm::perspective(camera.verticalFov, aspect, camera.nearPlane, camera.farPlane);
  const float up = camera.verticalExtent, right = up * aspect;
  return glm::ortho(-right, right, -up, up, camera.nearPlane, camera.farPlane);
}

/// Numbers of shaders/stage/lamps.glsl.
float typeNumber(LightType type) {
  switch (type) {
    case LightType::directional: return 0.0f;
    case LightType::point:
    case LightType::sphere: return 1.0f;
    case LightType::spot: return 2.0f;
    case LightType::disk: return 3.0f;
  }
  return 0.0f;
}

PunctualLightBlock blockOf(const Light& light) {
  PunctualLightBlock block;
  block.positionType = glm::vec4(light.position, typeNumber(light.type));
  block.directionRange = glm::vec4(light.direction, std::isfinite(light.range) && light.range > 0 ? 1.0f / light.range : 0.0f);
  const bool sized = light.type == LightType::sphere || light.type == LightType::disk;
  const float size = light.type == LightType::directional ? light.angle : sized ? light.radius : 0.0f;
  block.intensity = glm::vec4(light.color * light.intensity, size);
  // KHR_lights_punctual: clamp(cos * scale + offset)^2 between the outer and the inner cone.
  const float cosOuter = std::cos(light.outerConeAngle);
  const float scale = 1.0f / std::max(std::cos(light.innerConeAngle) - cosOuter, 1e-3f);
  block.cone = glm::vec4(scale, -cosOuter * scale, 0, 0);
  return block;
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
  GpuScene scene;
  std::vector<Light> lights;
  std::optional<GpuEnvironment> environment;
  gl::Program depthProgram, shadeProgram, backgroundProgram, resolveProgram, displayProgram;
  gl::Texture specularTable, albedoTable, modelTable;
  std::optional<MaterialFeatures> built;  // what the programs and modelTable are for
  int builtLobes = 0;
  gl::VertexArray noAttributes = gl::VertexArray::create();
  gl::Buffer frameBuffer{sizeof(FrameBlock)};
  gl::Program lightProgram;
  gl::Buffer lightVisibility;
  std::vector<glm::vec4> knownLights;  // axes and sharpness that lightVisibility holds
  std::unique_ptr<Target> shaded, resolved, displayed;
  std::vector<gl::TimerQuery> timers;
  gl::TimerQuery totalTimer = gl::TimerQuery::create();
  RenderSettings last;
  bool drawn = false;

  explicit Impl(const BakedScene& baked) : scene(baked) {
    setLights(baked.scene.lights);
    build(0);
    backgroundProgram =
        gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/background.frag"}});
    resolveProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/resolve.frag"}});
    displayProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/display.frag"}});
    if (scene.transfer().occludes()) lightProgram = gl::Program::loadCompute("shaders/stage/light_visibility.comp", scene.transfer().defines());

    const SpecularTable table = makeSpecularTable();
    specularTable = gl::Texture::make2dArray(GL_RGBA32F, table.roughnessCount, table.cosineCount, SpecularTable::kLobeCount);
    specularTable.upload(0, GL_RGBA, GL_FLOAT, table.entries.data());
    const AlbedoTable albedo = makeAlbedoTable();
    albedoTable = gl::Texture::make2d(GL_RGB32F, albedo.size, albedo.size);
    albedoTable.upload(0, GL_RGB, GL_FLOAT, albedo.entries.data());
    for (std::size_t i = 0; i < kPasses.size(); ++i) timers.push_back(gl::TimerQuery::create());
  }

  /// The programs and tables that the scene's materials ask for; nothing where they are there.
  void build(int lobes) {
    const MaterialFeatures& features = scene.features();
    if (built == features && builtLobes == lobes) return;
    modelTable = makeReflectanceTextures(features);
    auto defines = features.defines(kReflectanceLayers);
    depthProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/depth.frag"}}, defines);
    defines.push_back("LOBES " + std::to_string(lobes));
    for (auto& define : scene.transfer().defines()) defines.push_back(std::move(define));
    shadeProgram = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/shade.frag"}}, defines);
    built = features;
    builtLobes = lobes;
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

  FrameBlock frameBlock(const Camera& camera, const RenderSettings& settings) {
    FrameBlock frame;
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    frame.clipFromWorld = projectionOf(camera, aspect) * glm::inverse(camera.worldFromCamera);
    frame.worldFromClip = glm::inverse(frame.clipFromWorld);
    frame.eye = camera.perspective ? glm::vec4(glm::vec3(camera.worldFromCamera[3]), 1.0f)
                                   : glm::vec4(glm::normalize(glm::vec3(camera.worldFromCamera[2])), 0.0f);
    environment->fill(frame, settings.worldFromEnvironment, scene.directions(), scene.directionSharpness());
    frame.counts.y = static_cast<int>(lights.size());
    frame.counts.z = static_cast<int>(settings.debugView);
    frame.counts.w = static_cast<int>((settings.shadows ? kFlagShadows : 0u) | (settings.energyCompensation ? kFlagEnergyCompensation : 0u));
    for (std::size_t l = 0; l < lights.size(); ++l) frame.punctualLights[l] = blockOf(lights[l]);
    return frame;
  }

  /// What each vertex sees of each SG light: the same for every pixel, and for every frame until a light turns.
  void updateLightVisibility(const FrameBlock& frame) {
    if (!scene.transfer().occludes() || frame.counts.x == 0) return;
    std::vector<glm::vec4> wanted;
    for (int l = 0; l < frame.counts.x; ++l) wanted.push_back(frame.sgLights[l].axisSharpness);
    const std::size_t bytes = sizeof(std::uint32_t) * scene.transfer().vertexCount() * wanted.size();
    if (!lightVisibility || lightVisibility.size() < bytes) {
      lightVisibility = gl::Buffer(bytes);
      knownLights.clear();
    }
    lightVisibility.bindBase(GL_SHADER_STORAGE_BUFFER, 5);
    if (wanted == knownLights) return;
    lightProgram.use();
    const auto groups = (scene.transfer().vertexCount() + 63) / 64;
    const std::size_t row = 32768;  // of work groups; a driver need not take more than 65535 in one dimension
    lightProgram.set("rowGroups", static_cast<int>(row));
    lightProgram.set("vertexCount", static_cast<unsigned>(scene.transfer().vertexCount()));
    glDispatchCompute(static_cast<GLuint>(std::min(groups, row)), static_cast<GLuint>((groups + row - 1) / row), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    knownLights = std::move(wanted);
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

  void drawDepth() const {
    depthProgram.use();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    for (const auto& one : scene.draws())
      if (!blended(one)) draw(depthProgram, one);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
  }

  void drawShaded() const {
    shadeProgram.use();
    glDepthFunc(GL_EQUAL);
    for (const auto& one : scene.draws())
      if (!blended(one)) draw(shadeProgram, one);
  }

  /// Blended surfaces over what is behind them, farthest primitive first.
  void drawBlended(const Camera& camera) const {
    std::vector<const GpuDraw*> order;
    for (const auto& one : scene.draws())
      if (blended(one)) order.push_back(&one);
    if (order.empty()) return;
    const glm::vec3 eye(camera.worldFromCamera[3]);
    std::stable_sort(order.begin(), order.end(),
                     [&](const GpuDraw* a, const GpuDraw* b) { return glm::distance(a->center, eye) > glm::distance(b->center, eye); });
    shadeProgram.use();
    glDepthFunc(GL_LESS);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const auto* one : order) draw(shadeProgram, *one);
    glDisable(GL_BLEND);
  }

  void fullscreen(const gl::Program& program) const {
    program.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  void timed(std::size_t pass, const auto& body) const {
    timers[pass].begin();
    body();
    timers[pass].end();
  }

  void render(const Camera& camera, const RenderSettings& settings) {
    if (!environment) throw Error(ExitCode::failed, "render", "no environment was set", "call setEnvironment first");
    build(settings.lobes);
    resize(settings.width, settings.height, settings.supersample);
    FrameBlock frame = frameBlock(camera, settings);
    frameBuffer.write(0, std::span<const FrameBlock>(&frame, 1));

    totalTimer.begin();
    frameBuffer.bindBase(GL_UNIFORM_BUFFER, 0);
    scene.bindBuffers();
    updateLightVisibility(frame);
    environment->bindTextures();
    specularTable.bind(9);
    albedoTable.bind(10);
    if (modelTable) modelTable.bind(16);
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
    const float black[4] = {0, 0, 0, 0}, farthest = 1.0f;
    glClearNamedFramebufferfv(shaded->framebuffer.id(), GL_COLOR, 0, black);
    glClearNamedFramebufferfv(shaded->framebuffer.id(), GL_DEPTH, 0, &farthest);

    timed(0, [&] { drawDepth(); });
    timed(1, [&] { drawShaded(); });
    timed(2, [&] {
      if (!settings.background || settings.debugView != DebugView::none) return;
      glDisable(GL_CULL_FACE);
      glDepthFunc(GL_LEQUAL);
      fullscreen(backgroundProgram);
    });
    timed(3, [&] { drawBlended(camera); });
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    timed(4, [&] {
      resolved->framebuffer.bind();
      shaded->color.bind(0);
      resolveProgram.set("supersample", settings.supersample);
      fullscreen(resolveProgram);
    });
    totalTimer.end();
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

void Renderer::setEnvironment(const SgEnvironment& environment) { impl_->environment.emplace(environment); }
void Renderer::setLights(const std::vector<Light>& lights) { impl_->setLights(lights); }
void Renderer::setMaterials(const std::vector<Material>& materials) { impl_->scene.setMaterials(materials); }

void Renderer::render(const Camera& camera, const RenderSettings& settings) {
  if (settings.width < 1 || settings.height < 1 || settings.supersample < 1 || settings.supersample > 8)
    throw usageError("size", "a picture needs at least one pixel and 1 to 8 samples a side", "check width, height and supersample");
  requireLobes(settings.lobes, "lobes");
  impl_->render(camera, settings);
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

FrameTimings Renderer::timings() {
  impl_->requireFrame();
  FrameTimings timings;
  for (std::size_t i = 0; i < kPasses.size(); ++i) timings.passes.emplace_back(kPasses[i], 1e3 * impl_->timers[i].seconds());
  timings.passes.emplace_back("total", 1e3 * impl_->totalTimer.seconds());
  return timings;
}

std::size_t Renderer::gpuBytes() const {
  std::size_t bytes = impl_->scene.bytes() + (impl_->environment ? impl_->environment->bytes() : 0);
  for (const auto* target : {&impl_->shaded, &impl_->resolved, &impl_->displayed})
    if (*target) bytes += (*target)->bytes();
  return bytes;
}

}  // namespace chiaro
