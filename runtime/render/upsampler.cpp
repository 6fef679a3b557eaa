#include "runtime/render/upsampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace chiaro {
namespace {

constexpr float kDarkest = 0.02f;      // light that hardly shows, exposed
constexpr float kDarkestShare = 0.04f;  // the same, of an environment's mean
constexpr std::size_t kUrgencyBytes = 68 * sizeof(std::uint32_t);  // shaders/stage/upsample_list.glsl

/// In which order the pixels of a cell are shaded: each far from those just before it.
glm::ivec2 jitterOf(int cell, int frame) {
  static constexpr std::array<std::array<int, 2>, 4> kTwo{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
  static constexpr std::array<std::array<int, 2>, 9> kThree{{{1, 1}, {0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 0}, {1, 2}, {0, 1}, {2, 1}}};
  if (cell == 2) return {kTwo[static_cast<std::size_t>(frame % 4)][0], kTwo[static_cast<std::size_t>(frame % 4)][1]};
  if (cell == 3) return {kThree[static_cast<std::size_t>(frame % 9)][0], kThree[static_cast<std::size_t>(frame % 9)][1]};
  const auto coarse = kTwo[static_cast<std::size_t>(frame % 4)], fine = kTwo[static_cast<std::size_t>(frame / 4 % 4)];
  return {2 * coarse[0] + fine[0], 2 * coarse[1] + fine[1]};
}

/// Of window depth that the height of a pixel is: x + y depth.
glm::vec2 depthScaleOf(const Camera& camera, int height) {
  const float near = camera.nearPlane, far = camera.farPlane, pixel = 2.0f / static_cast<float>(height);
  // Perspective: depth = infinite - infinite near / z, whose change with log z is infinite - depth.
  if (camera.perspective) return pixel * std::tan(0.5f * camera.verticalFov) * glm::vec2(far / (far - near), -1.0f);
  return {pixel * camera.verticalExtent / (far - near), 0.0f};
}

void fullscreen(const gl::Program& program) {
  program.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

gl::Program pass(const char* fragment, const std::vector<std::string>& defines = {}) {
  return gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/fullscreen.vert"}, {GL_FRAGMENT_SHADER, fragment}}, defines);
}

bool shadeAlike(const RenderSettings& a, const RenderSettings& b) {
  return a.upsample == b.upsample && a.upsampleWeights == b.upsampleWeights && estimatesWhenUpsampled(a) == estimatesWhenUpsampled(b) && a.shadows == b.shadows &&
         a.energyCompensation == b.energyCompensation && a.lobes == b.lobes;
}

}  // namespace

Upsampler::Upsampler()
    : filterProgram_(pass("shaders/stage/upsample_filter.frag")),
      cutProgram_(gl::Program::loadCompute("shaders/stage/upsample_cut.comp")),
      listProgram_(pass("shaders/stage/upsample_list.frag")),
      composeProgram_(pass("shaders/stage/upsample_compose.frag")),
      urgencies_(kUrgencyBytes) {}

void Upsampler::build(const std::vector<std::string>& defines, bool shapes) {
  auto surfaceDefines = defines;
  surfaceDefines.push_back("SHAPES " + std::to_string(shapes));
  surfaceProgram_ = gl::Program::load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/upsample_surface.frag"}}, surfaceDefines);
  estimateProgram_ = pass("shaders/stage/upsample_estimate.frag", defines);
  shadeProgram_ = pass("shaders/stage/upsample_shade.frag", defines);
  auto recomputeDefines = defines;
  recomputeDefines.push_back("RECOMPUTE");
  recomputeProgram_ = gl::Program::load(
      {{GL_VERTEX_SHADER, "shaders/stage/upsample_recompute.vert"}, {GL_FRAGMENT_SHADER, "shaders/stage/upsample_shade.frag"}}, recomputeDefines);
  forget();
}

void Upsampler::allocate(glm::ivec2 size, int cell) {
  const auto make = [](GLenum format, glm::ivec2 of) { return gl::Texture::make2d(format, of.x, of.y); };
  if (size != size_) {
    size_ = size;
    for (auto* texture : {&place_, &colors_, &before_, &albedos_, &guide_}) *texture = make(GL_RGBA32UI, size);
    body_ = make(GL_R8UI, size);
    estimated_ = gl::Framebuffer::make({&albedos_, &guide_});
    quality_ = make(GL_RGBA16F, size);
    for (int k = 0; k < 2; ++k) {
      kept_[k] = {make(GL_RGBA32F, size), make(GL_RGBA32F, size), make(GL_RGBA32UI, size)};
      filtered_[k] = gl::Framebuffer::make({&kept_[k].diffuse, &kept_[k].reflected, &kept_[k].guide, &quality_});
    }
    pixels_ = gl::Buffer(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * sizeof(std::uint32_t));
    cell_ = 0;
  }
  if (cell == cell_) return;
  cell_ = cell;
  coarse_ = (size + cell - 1) / cell;
  coarseDiffuse_ = make(GL_RGBA32F, coarse_);
  coarseReflected_ = make(GL_RGBA32F, coarse_);
  coarseGuide_ = make(GL_RGBA32UI, coarse_);
  coarseTarget_ = gl::Framebuffer::make({&coarseDiffuse_, &coarseReflected_, &coarseGuide_});
  forget();
}

void Upsampler::begin(const gl::Texture& color, const gl::Texture& depth, const Camera& camera, const RenderSettings& settings, float meanRadiance) {
  allocate({color.width(), color.height()}, settings.upsample);
  if (!shadeAlike(settings, settings_)) forget();
  settings_ = settings;
  darkest_ = std::max(kDarkestShare * meanRadiance, 1e-20f);
  surfaces_ = gl::Framebuffer::make({&color, &place_, &colors_, &before_, &body_}, &depth);
  composed_ = gl::Framebuffer::make({&color});
  depthScaleBefore_ = depthScale_;
  depthScale_ = depthScaleOf(camera, size_.y);
  jitter_ = jitterOf(cell_, frame_);
  now_ ^= 1;
  ++frame_;
}

void Upsampler::bindSurfaces() const {
  surfaces_.bind();
  const GLuint nobody[4] = {255, 0, 0, 0};  // shaders/stage/upsample_guide.glsl
  glClearNamedFramebufferuiv(surfaces_.id(), GL_COLOR, 4, nobody);
  surfaceProgram_.set("size", glm::vec2(size_));
  surfaceProgram_.set("depthScale", depthScale_);
}

void Upsampler::setBody(int body, const glm::mat4& clipFromWorldBefore) const {
  surfaceProgram_.set("body", body);
  surfaceProgram_.set("clipFromWorldBefore", clipFromWorldBefore);
}

void Upsampler::setHistory(const gl::Program& program) const {
  const Kept& before = kept_[now_ ^ 1];
  before.diffuse.bind(17);
  before.reflected.bind(18);
  before.guide.bind(19);
  program.set("historyHolds", historyHolds_ ? 1 : 0);
  program.set("depthScaleBefore", depthScaleBefore_);
  program.set("weights", static_cast<int>(settings_.upsampleWeights));
}

void Upsampler::estimate(int bodies, const std::function<void(int)>& bindBody, const gl::Texture& depth) const {
  estimated_.bind();
  place_.bind(0);
  colors_.bind(1);
  before_.bind(2);
  body_.bind(3);
  depth.bind(13);
  estimateProgram_.set("estimates", estimatesWhenUpsampled(settings_) ? 1 : 0);
  estimateProgram_.set("darkest", darkest_);
  for (int body = 0; body < bodies; ++body) {
    bindBody(body);
    estimateProgram_.set("body", body);
    fullscreen(estimateProgram_);
  }
}

void Upsampler::shade(int bodies, const std::function<void(int)>& bindBody) const {
  coarseTarget_.bind();
  place_.bind(0);
  colors_.bind(1);
  albedos_.bind(2);
  guide_.bind(3);
  before_.bind(13);
  setHistory(shadeProgram_);
  shadeProgram_.set("jitter", jitter_);
  shadeProgram_.set("cell", cell_);
  shadeProgram_.set("darkest", estimatesWhenUpsampled(settings_) ? kDarkest * darkest_ : kDarkest / settings_.exposure);
  for (int body = 0; body < bodies; ++body) {
    bindBody(body);
    shadeProgram_.set("body", body);
    fullscreen(shadeProgram_);
  }
}

void Upsampler::filter() {
  recomputes_ = settings_.upsampleWeights != UpsampleWeights::bilinear && (settings_.recompute.share > 0.0f || settings_.recompute.milliseconds > 0.0f);
  const GLuint zero = 0;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);  // what the last frame's recomputation stored
  glClearNamedBufferData(urgencies_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  urgencies_.bindBase(GL_SHADER_STORAGE_BUFFER, 8);
  pixels_.bindBase(GL_SHADER_STORAGE_BUFFER, 9);
  filtered_[now_].bind();
  guide_.bind(0);
  albedos_.bind(1);
  before_.bind(2);
  coarseDiffuse_.bind(7);
  coarseReflected_.bind(8);
  coarseGuide_.bind(9);
  setHistory(filterProgram_);
  filterProgram_.set("jitter", jitter_);
  filterProgram_.set("cell", cell_);
  filterProgram_.set("depthScale", depthScale_);
  filterProgram_.set("exposure", settings_.exposure);
  filterProgram_.set("recompute", recomputes_ ? 1 : 0);
  fullscreen(filterProgram_);
}

void Upsampler::recompute(int bodies, const std::function<void(int)>& bindBody, unsigned pixels) {
  budget_ = pixels;
  if (pixels == 0 || !recomputes_) return;
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  cutProgram_.set("budget", pixels);
  cutProgram_.use();
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

  composed_.bind();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  quality_.bind(0);
  listProgram_.set("budget", pixels);
  listProgram_.set("seed", static_cast<unsigned>(frame_));
  fullscreen(listProgram_);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);

  const Kept& kept = kept_[now_];
  place_.bind(0);
  colors_.bind(1);
  albedos_.bind(2);
  guide_.bind(3);
  kept.diffuse.bindImage(0, 0, GL_WRITE_ONLY);
  kept.reflected.bindImage(1, 0, GL_WRITE_ONLY);
  kept.guide.bindImage(2, 0, GL_WRITE_ONLY);
  quality_.bindImage(3, 0, GL_READ_WRITE);
  recomputeProgram_.set("budget", pixels);
  recomputeProgram_.set("size", size_);
  recomputeProgram_.use();
  for (int body = 0; body < bodies; ++body) {
    bindBody(body);
    recomputeProgram_.set("body", body);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Upsampler::compose() {
  composed_.bind();
  const Kept& kept = kept_[now_];
  guide_.bind(0);
  albedos_.bind(1);
  kept.diffuse.bind(2);
  kept.reflected.bind(3);
  kept.guide.bind(4);
  quality_.bind(5);
  composeProgram_.set("view", static_cast<int>(settings_.debugView));
  const bool light = settings_.debugView == DebugView::none;
  if (light) glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  fullscreen(composeProgram_);
  glDisable(GL_BLEND);
  historyHolds_ = true;
}

std::pair<unsigned, unsigned> Upsampler::recomputed() const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const auto words = urgencies_.read<std::uint32_t>();
  return {words[67], std::min(words[kListedOffset / sizeof(std::uint32_t)], budget_)};
}

std::size_t Upsampler::bytes() const {
  const auto area = [](glm::ivec2 of) { return static_cast<std::size_t>(of.x) * static_cast<std::size_t>(of.y); };
  return area(size_) * (5 * 16 + 1 + 8 + 2 * 3 * 16 + 4) + area(coarse_) * 3 * 16;
}

}  // namespace chiaro
