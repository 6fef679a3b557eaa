#include "runtime/viewer/animation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "assets/error.h"
#include "assets/scene/motion.h"

namespace chiaro {
namespace {

constexpr double kPeriod = 4.0;
constexpr double kTurnDegreesPerSecond = 30.0;
constexpr double kShapesPerSecond = 30.0;
constexpr int kSize = 256, kCoarsestCells = 8, kOctaves = 4;
constexpr float kShore = 0.2f;         // between dry and soaked, as a share of all heights
constexpr float kMapsAcross = 1.5f;    // the scene's diagonal, so that the repetition hardly shows

/// Smooth noise of `cells` random heights a side, repeating.
void addNoise(std::vector<float>& heights, int cells, float scale, std::mt19937& random) {
  std::vector<float> nodes(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
  for (float& node : nodes) node = static_cast<float>(random()) * 0x1p-32f;
  const auto node = [&](int i, int j) { return nodes[static_cast<std::size_t>((j % cells) * cells + i % cells)]; };
  const auto smooth = [](float x) { return x * x * (3.0f - 2.0f * x); };
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float u = static_cast<float>(x * cells) / kSize, v = static_cast<float>(y * cells) / kSize;
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      const float a = smooth(u - static_cast<float>(i)), b = smooth(v - static_cast<float>(j));
      heights[static_cast<std::size_t>(y * kSize + x)] +=
          scale * glm::mix(glm::mix(node(i, j), node(i + 1, j), a), glm::mix(node(i, j + 1), node(i + 1, j + 1), a), b);
    }
}

/// Each number's place among all, 0 to 1.
std::vector<float> ranked(const std::vector<float>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<float> ranks(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) ranks[order[k]] = static_cast<float>(k) / static_cast<float>(order.size() - 1);
  return ranks;
}

}  // namespace

Animation animationFromName(const std::string& name) {
  if (name == "none") return Animation::none;
  if (name == "wetness") return Animation::wetness;
  if (name == "scene") return Animation::scene;
  throw usageError("--animate", "unknown animation \"" + name + "\"", "give none, wetness or scene");
}

Shower::Shower(const Scene& scene) {
  std::vector<float> heights(static_cast<std::size_t>(kSize) * kSize, 0.0f);
  std::mt19937 random(7);
  for (int octave = 0; octave < kOctaves; ++octave) addNoise(heights, kCoarsestCells << octave, std::exp2(-static_cast<float>(octave)), random);
  height_ = ranked(heights);
  const float maps = kMapsAcross / std::max(boundsOf(scene).diagonal(), 1e-30f);
  wetness_ = {kSize, kSize, std::vector<std::uint8_t>(height_.size()), {maps, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, maps, 0.0f}};
}

const Wetness& Shower::at(double seconds) {
  const float rain = static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * seconds / kPeriod)), level = rain * (1.0f + kShore);
  for (std::size_t k = 0; k < height_.size(); ++k)
    wetness_.texels[k] = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp((level - height_[k]) / kShore, 0.0f, 1.0f)));
  return wetness_;
}

Animator::Animator(const Scene& scene, Animation animation, const std::string& moving, const VertexCacheFiles& shapes) {
  if (animation == Animation::wetness) shower_.emplace(scene);
  if (!moving.empty()) moving_.emplace(scene, moving);
  if (!shapes.frames.empty()) shapes_.emplace(scene, shapes);
  if (animation != Animation::scene) return;
  if (scene.motions.empty()) throw usageError("--animate", "the scene has no animation of rigid meshes", "give another animation, or bake an animated file");
  played_.meshNames = scene.meshNames;
  played_.motions = scene.motions;
}

void Animator::apply(Renderer& renderer, double seconds) {
  if (shower_) renderer.setWetness(shower_->at(seconds));
  if (shapes_) renderer.setShapes(shapes_->at(kShapesPerSecond * seconds));
  if (!moving_ && played_.motions.empty()) return;
  std::vector<glm::mat4> poses;
  if (!played_.motions.empty()) {
    const double length = motionSeconds(played_);
    poses = posesAt(played_, length > 0.0 ? seconds - length * std::floor(seconds / length) : 0.0);
  }
  if (moving_) {
    auto turned = moving_->poses(kTurnDegreesPerSecond * seconds);
    for (std::size_t mesh = 0; mesh < poses.size(); ++mesh) turned[mesh] = poses[mesh] * turned[mesh];
    poses = std::move(turned);
  }
  renderer.setPoses(poses);
}

}  // namespace chiaro
