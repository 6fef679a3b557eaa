#include "assets/scene/camera_spec.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSmallest = 1e-15f;  // metres, for a scene that is a point
constexpr float kPoleMargin = kPi / 180.0f;
constexpr const char* kForms = "give auto, an index, a name, or eye=X,Y,Z,target=X,Y,Z,fov-deg=40";

float radiansOf(float degrees) { return degrees * (kPi / 180.0f); }

std::optional<float> numberOf(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  float value = 0.0f;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// `key=number,number,...` groups of the look-at form.
class LookAtParser {
 public:
  LookAtParser(std::string_view text, const std::string& option) : option_(option) {
    for (auto part : split(text, ',')) {
      if (const auto equals = part.find('='); equals != std::string_view::npos) {
        startGroup(part.substr(0, equals));
        part.remove_prefix(equals + 1);
      }
      const auto number = numberOf(part);
      if (!number || current_ == nullptr) throw fail("\"" + std::string(part) + "\" is not a number");
      current_->push_back(*number);
    }
  }

  CameraSpec spec() const {
    CameraSpec spec;
    spec.kind = CameraSpec::Kind::lookAt;
    spec.eye = vector("eye", eye_);
    spec.target = vector("target", target_);
    if (!fov_.empty()) {
      if (fov_.size() != 1) throw fail("fov-deg takes one number");
      if (!(fov_[0] > 0.0f && fov_[0] < 180.0f)) throw fail("fov-deg must lie between 0 and 180");
      spec.verticalFov = radiansOf(fov_[0]);
    }
    if (!(glm::length(spec.eye - spec.target) > 0.0f)) throw fail("eye and target are the same point");
    return spec;
  }

 private:
  Error fail(const std::string& what) const { return usageError(option_, what, kForms); }

  void startGroup(std::string_view key) {
    if (key == "eye") current_ = &eye_;
    else if (key == "target") current_ = &target_;
    else if (key == "fov-deg") current_ = &fov_;
    else throw fail("unknown key \"" + std::string(key) + "\"");
    if (!current_->empty()) throw fail("\"" + std::string(key) + "\" is given twice");
  }

  glm::vec3 vector(const char* key, const std::vector<float>& values) const {
    if (values.size() != 3) throw fail(std::string(key) + " needs three numbers, not " + std::to_string(values.size()));
    return {values[0], values[1], values[2]};
  }

  const std::string& option_;
  std::vector<float> eye_, target_, fov_;
  std::vector<float>* current_ = nullptr;
};

std::string camerasOf(const Scene& scene) {
  if (scene.cameras.empty()) return "the file has no camera; use auto or eye=X,Y,Z,target=X,Y,Z";
  std::string names;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    names += (i == 0 ? "" : ", ") + std::to_string(i) + " (" + scene.cameras[i].name + ")";
  return "the file has " + names;
}

glm::vec3 backOf(const Camera& camera) { return glm::vec3(camera.worldFromCamera[2]); }
glm::vec3 eyeOf(const Camera& camera) { return glm::vec3(camera.worldFromCamera[3]); }

std::string shortest(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

}  // namespace

CameraSpec parseCameraSpec(const std::string& text, const std::string& option) {
  CameraSpec spec;
  if (text.empty()) throw usageError(option, "is empty", kForms);
  if (text == "auto") return spec;
  if (text.starts_with("name=")) {
    spec.kind = CameraSpec::Kind::name;
    spec.name = text.substr(5);
    return spec;
  }
  if (text.find('=') != std::string::npos) return LookAtParser(text, option).spec();
  if (std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; })) {
    spec.kind = CameraSpec::Kind::index;
    const auto status = std::from_chars(text.data(), text.data() + text.size(), spec.index).ec;
    if (status != std::errc()) throw usageError(option, "\"" + text + "\" is too large an index", kForms);
    return spec;
  }
  spec.kind = CameraSpec::Kind::name;
  spec.name = text;
  return spec;
}

std::string lookAtSpec(glm::vec3 eye, glm::vec3 target, float verticalFov) {
  const auto vector = [](glm::vec3 v) { return shortest(v.x) + "," + shortest(v.y) + "," + shortest(v.z); };
  return "eye=" + vector(eye) + ",target=" + vector(target) + ",fov-deg=" + shortest(verticalFov * (180.0f / kPi));
}

Camera resolveCamera(const CameraSpec& spec, const Scene& scene, float aspect, const std::string& option) {
  switch (spec.kind) {
    case CameraSpec::Kind::automatic: return defaultCamera(scene, aspect);
    case CameraSpec::Kind::lookAt: return lookAt(spec.eye, spec.target, spec.verticalFov, boundsOf(scene));
    case CameraSpec::Kind::index:
      if (static_cast<std::size_t>(spec.index) < scene.cameras.size()) return scene.cameras[static_cast<std::size_t>(spec.index)];
      throw usageError(option, "there is no camera " + std::to_string(spec.index), camerasOf(scene));
    case CameraSpec::Kind::name: break;
  }
  const auto found =
      std::find_if(scene.cameras.begin(), scene.cameras.end(), [&](const Camera& camera) { return camera.name == spec.name; });
  if (found == scene.cameras.end()) throw usageError(option, "there is no camera \"" + spec.name + "\"", camerasOf(scene));
  return *found;
}

glm::vec2 parseOrbit(const std::string& text, const std::string& option) {
  const auto parts = split(text, ',');
  const auto azimuth = numberOf(parts[0]);
  const auto elevation = parts.size() == 2 ? numberOf(parts[1]) : std::nullopt;
  if (!azimuth || !elevation) throw usageError(option, "\"" + text + "\" is not two angles", "give AZIMUTH,ELEVATION in degrees, such as 30,-10");
  return {radiansOf(std::fmod(*azimuth, 360.0f)), radiansOf(std::clamp(*elevation, -180.0f, 180.0f))};
}

glm::vec3 orbitTarget(const Camera& camera, const Bounds& bounds) {
  const glm::vec3 center = bounds.empty() ? glm::vec3(0.0f) : bounds.center();
  const float ahead = glm::dot(eyeOf(camera) - center, backOf(camera));
  const float radius = std::max(0.5f * bounds.diagonal(), kSmallest);
  return eyeOf(camera) - (ahead > 0.0f ? ahead : radius) * backOf(camera);
}

Camera orbited(const Camera& camera, glm::vec3 target, float azimuth, float elevation) {
  if (azimuth == 0.0f && elevation == 0.0f) return camera;
  glm::mat4 turn = glm::rotate(glm::mat4(1.0f), azimuth, glm::vec3(0, 1, 0));
  const glm::vec3 back = glm::vec3(turn * glm::vec4(backOf(camera), 0.0f));
  const float now = std::asin(std::clamp(back.y, -1.0f, 1.0f));
  const float limit = std::max(0.5f * kPi - kPoleMargin, std::abs(now));
  const float lift = std::clamp(now + elevation, -limit, limit) - now;
  // The horizontal axis to lift about; straight above or below, the camera's own right is the only one there is.
  const glm::vec3 side = glm::cross(glm::vec3(0, 1, 0), back);
  const glm::vec3 axis = glm::length(side) > 1e-4f ? glm::normalize(side) : glm::vec3(turn * camera.worldFromCamera[0]);
  turn = glm::rotate(glm::mat4(1.0f), -lift, axis) * turn;

  Camera moved = camera;
  for (int column = 0; column < 3; ++column)
    moved.worldFromCamera[column] = glm::vec4(glm::normalize(glm::vec3(turn * camera.worldFromCamera[column])), 0.0f);
  moved.worldFromCamera[3] = glm::vec4(target + glm::vec3(turn * glm::vec4(eyeOf(camera) - target, 0.0f)), 1.0f);
  return moved;
}

void fitDepthRange(Camera& camera, const Bounds& bounds) {
  const float radius = 0.5f * bounds.diagonal();
  const float distance = bounds.empty() ? 1.0f : glm::length(eyeOf(camera) - bounds.center());
  camera.farPlane = std::max(distance + 1.1f * radius, kSmallest);
  camera.nearPlane = std::max(distance - 1.1f * radius, 1e-3f * camera.farPlane);
}

}  // namespace chiaro
