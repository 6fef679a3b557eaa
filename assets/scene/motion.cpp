#include "assets/scene/motion.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace chiaro {
namespace {

glm::mat4 poseAt(const RigidMotion& motion, double seconds) {
  const auto later = std::upper_bound(motion.times.begin(), motion.times.end(), static_cast<float>(seconds));
  const auto next = static_cast<std::size_t>(later - motion.times.begin());
  const std::size_t a = next == 0 ? 0 : next - 1, b = std::min(next, motion.times.size() - 1);
  const float span = motion.times[b] - motion.times[a];
  const float share = span > 0.0f ? std::clamp((static_cast<float>(seconds) - motion.times[a]) / span, 0.0f, 1.0f) : 0.0f;
  glm::mat4 pose = glm::mat4_cast(glm::slerp(motion.rotations[a], motion.rotations[b], share));
  pose[3] = glm::vec4(glm::mix(motion.shifts[a], motion.shifts[b], share), 1.0f);
  return pose;
}

}  // namespace

std::vector<glm::mat4> posesAt(const Scene& scene, double seconds) {
  std::vector<glm::mat4> poses(scene.meshNames.size(), glm::mat4(1.0f));
  for (const auto& motion : scene.motions) poses[static_cast<std::size_t>(motion.mesh)] = poseAt(motion, seconds);
  return poses;
}

double motionSeconds(const Scene& scene) {
  float last = 0.0f;
  for (const auto& motion : scene.motions) last = std::max(last, motion.times.back());
  return static_cast<double>(last);
}

}  // namespace chiaro
