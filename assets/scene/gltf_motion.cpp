#include "assets/scene/gltf_motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr double kStep = 1.0 / 30.0;
constexpr std::size_t kMostKeys = 20000;  // of a mesh; longer animations get longer steps
constexpr double kRigid = 1e-3;           // how far from a rotation a pose may be

/// A channel: one property of one node over time.
struct Curve {
  enum class Kind { step, linear, cubic } kind = Kind::linear;
  int components = 3;
  std::vector<float> times, values;

  glm::dvec4 key(std::size_t i) const {
    glm::dvec4 v(0.0);
    for (int c = 0; c < components; ++c) v[c] = static_cast<double>(values[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)]);
    return v;
  }

  glm::dvec4 at(double seconds) const {
    const std::size_t each = kind == Kind::cubic ? 3 : 1, value = kind == Kind::cubic ? 1 : 0;
    const auto later = std::upper_bound(times.begin(), times.end(), static_cast<float>(seconds));
    const auto next = static_cast<std::size_t>(later - times.begin());
    if (next == 0) return key(value);
    if (next == times.size() || kind == Kind::step) return key((next - 1) * each + value);
    const double span = static_cast<double>(times[next] - times[next - 1]), t = std::clamp((seconds - static_cast<double>(times[next - 1])) / span, 0.0, 1.0);
    const glm::dvec4 from = key((next - 1) * each + value), to = key(next * each + value);
    if (kind == Kind::cubic) {
      const glm::dvec4 out = span * key((next - 1) * each + 2), in = span * key(next * each);
      return (2 * t * t * t - 3 * t * t + 1) * from + (t * t * t - 2 * t * t + t) * out + (3 * t * t - 2 * t * t * t) * to + (t * t * t - t * t) * in;
    }
    if (components == 3) return glm::mix(from, to, t);
    const glm::dquat q = glm::slerp(glm::dquat(from.w, from.x, from.y, from.z), glm::dquat(to.w, to.x, to.y, to.z), t);
    return {q.x, q.y, q.z, q.w};
  }
};

struct NodeCurves {
  std::map<std::string, Curve> of;  // translation, rotation, scale
};

glm::dmat4 transformOf(const tinygltf::Node& node, const NodeCurves& curves, double seconds) {
  tinygltf::Node moved = node;
  for (const auto& [property, curve] : curves.of) {
    const glm::dvec4 v = curve.at(seconds);
    if (property == "translation") moved.translation = {v.x, v.y, v.z};
    else if (property == "scale") moved.scale = {v.x, v.y, v.z};
    else if (const double size = glm::length(v); size > 0.0) moved.rotation = {v.x / size, v.y / size, v.z / size, v.w / size};
  }
  return localTransform(moved);
}

class MotionReader {
 public:
  MotionReader(const tinygltf::Model& model, const GltfAccessors& accessors, const std::string& where, Warnings& warnings)
      : model_(model), accessors_(accessors), where_(where), warnings_(warnings) {
    if (model.animations.size() > 1) warnings.say("of " + std::to_string(model.animations.size()) + " animations the first is kept");
    const auto& animation = model.animations.front();
    for (std::size_t c = 0; c < animation.channels.size(); ++c) readChannel(animation, c);
  }

  std::vector<RigidMotion> motions(const std::vector<MeshNodes>& meshes) const {
    std::vector<RigidMotion> all;
    for (const auto& mesh : meshes) {
      const auto times = timesOf(mesh.path);
      if (times.empty()) continue;
      const glm::dmat4 rest = worldOf(mesh.path, -1.0, false);
      if (!(std::abs(glm::determinant(glm::dmat3(rest))) > 0.0)) {
        warnings_.say(mesh.label + " is flattened, so its animation is left out");
        continue;
      }
      RigidMotion motion = motionOf(mesh, times, glm::inverse(rest));
      if (!motion.times.empty()) all.push_back(std::move(motion));
    }
    return all;
  }

 private:
  void readChannel(const tinygltf::Animation& animation, std::size_t index) {
    const auto& channel = animation.channels[index];
    const std::string what = "animation channel " + std::to_string(index);
    if (channel.target_node < 0) return;
    if (static_cast<std::size_t>(channel.target_node) >= model_.nodes.size()) fail(what + " names a node that does not exist");
    if (channel.target_path == "weights") return warnings_.say("morph targets are not animated: their meshes keep the shape they rest in");
    if (channel.target_path != "translation" && channel.target_path != "rotation" && channel.target_path != "scale") return;
    if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= animation.samplers.size()) fail(what + " names a sampler that does not exist");
    const auto& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
    Curve curve;
    curve.components = channel.target_path == "rotation" ? 4 : 3;
    curve.kind = sampler.interpolation == "STEP" ? Curve::Kind::step : sampler.interpolation == "CUBICSPLINE" ? Curve::Kind::cubic : Curve::Kind::linear;
    curve.times = accessors_.floats(sampler.input, 1, Integers::none, "the times of " + what);
    curve.values = accessors_.floats(sampler.output, curve.components, Integers::normalizedSigned, "the values of " + what);
    const std::size_t expected = curve.times.size() * static_cast<std::size_t>(curve.components) * (curve.kind == Curve::Kind::cubic ? 3 : 1);
    if (curve.times.empty() || curve.values.size() != expected) fail(what + " has " + std::to_string(curve.values.size()) + " values for " + std::to_string(curve.times.size()) + " times");
    for (std::size_t i = 0; i < curve.times.size(); ++i)
      if (!(curve.times[i] >= 0.0f) || (i > 0 && !(curve.times[i] > curve.times[i - 1]))) fail("the times of " + what + " do not rise");
    curves_[channel.target_node].of[channel.target_path] = std::move(curve);
  }

  std::vector<double> timesOf(const std::vector<int>& path) const {
    std::vector<double> keys;
    for (const int node : path)
      if (const auto found = curves_.find(node); found != curves_.end())
        for (const auto& [property, curve] : found->second.of) keys.insert(keys.end(), curve.times.begin(), curve.times.end());
    if (keys.empty()) return keys;
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    const double step = std::max(kStep, (keys.back() - keys.front()) / static_cast<double>(kMostKeys));
    std::vector<double> times;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (i > 0) {
        const double from = keys[i - 1], parts = std::ceil((keys[i] - from) / step - 1e-6);
        for (double k = 1.0; k < parts; k += 1.0) times.push_back(from + (keys[i] - from) * k / parts);
      }
      times.push_back(keys[i]);
    }
    return times;
  }

  glm::dmat4 worldOf(const std::vector<int>& path, double seconds, bool moving) const {
    glm::dmat4 world(1.0);
    for (const int index : path) {
      const auto& node = model_.nodes[static_cast<std::size_t>(index)];
      const auto found = curves_.find(index);
      world = world * (moving && found != curves_.end() ? transformOf(node, found->second, seconds) : localTransform(node));
    }
    return world;
  }

  RigidMotion motionOf(const MeshNodes& mesh, const std::vector<double>& times, const glm::dmat4& restFromWorld) const {
    RigidMotion motion;
    motion.mesh = mesh.mesh;
    bool moves = false;
    for (const double seconds : times) {
      const glm::dmat4 pose = worldOf(mesh.path, seconds, true) * restFromWorld;
      const glm::dmat3 turn(pose);
      const glm::dmat3 square = glm::transpose(turn) * turn - glm::dmat3(1.0);
      double off = std::abs(glm::determinant(turn) - 1.0);
      for (int c = 0; c < 3; ++c) off = std::max(off, glm::length(square[c]));
      if (!(off <= kRigid)) {
        warnings_.say(mesh.label + " is animated by more than rotation and shift, and rests");
        return {};
      }
      const glm::quat rotation(glm::normalize(glm::quat_cast(turn)));
      motion.times.push_back(static_cast<float>(seconds));
      motion.rotations.push_back(motion.rotations.empty() || glm::dot(rotation, motion.rotations.back()) >= 0.0f ? rotation : -rotation);
      motion.shifts.emplace_back(glm::dvec3(pose[3]));
      moves = moves || glm::length(motion.shifts.back()) > 1e-7f || std::abs(rotation.w) < 1.0f - 1e-7f;
    }
    if (!moves) return {};
    // Two keys of doubles may be one as floats.
    for (std::size_t i = 1; i < motion.times.size(); ++i)
      if (!(motion.times[i] > motion.times[i - 1])) motion.times[i] = std::nextafter(motion.times[i - 1], 3.4e38f);
    return motion;
  }

  [[noreturn]] void fail(const std::string& what) const { throw inputError(where_, what, "export it again"); }

  const tinygltf::Model& model_;
  const GltfAccessors& accessors_;
  const std::string& where_;
  Warnings& warnings_;
  std::map<int, NodeCurves> curves_;
};

}  // namespace

glm::dmat4 localTransform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dmat4 m(1.0);
  if (node.scale.size() == 3)
    for (int i = 0; i < 3; ++i) m[i][i] = node.scale[static_cast<std::size_t>(i)];
  if (node.rotation.size() == 4) {
    const auto& r = node.rotation;
    m = glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2]))) * m;
  }
  if (node.translation.size() == 3) m[3] = {node.translation[0], node.translation[1], node.translation[2], 1.0};
  return m;
}

std::vector<RigidMotion> readGltfMotions(const tinygltf::Model& model, const GltfAccessors& accessors, const std::vector<MeshNodes>& meshes, const std::string& where,
                                         Warnings& warnings) {
  if (model.animations.empty()) return {};
  return MotionReader(model, accessors, where, warnings).motions(meshes);
}

}  // namespace chiaro
