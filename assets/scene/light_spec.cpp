#include "assets/scene/light_spec.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr float kRadiansPerDegree = std::numbers::pi_v<float> / 180.0f;
/// KHR's attenuation is 1 up to within .01 degree of the disk's plane: Lambert's disk, without a cone.
constexpr glm::vec2 kNoCone{89.99f, 90.0f};
constexpr const char* kExample = "give a light such as sphere,at=0,3,0,radius=0.2,intensity=10";
const std::array<std::pair<std::string_view, LightType>, 5> kKinds{{{"sun", LightType::directional},
                                                                     {"point", LightType::point},
                                                                     {"spot", LightType::spot},
                                                                     {"sphere", LightType::sphere},
                                                                     {"disk", LightType::disk}}};

std::optional<float> numberOf(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  float value = 0.0f;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

class LightParser {
 public:
  LightParser(std::string_view text, const std::string& option) : option_(option) {
    readKind(text.substr(0, text.find(',')));
    std::vector<float>* group = nullptr;
    for (auto at = text.find(','); at != std::string_view::npos;) {
      const auto next = text.find(',', at + 1);
      std::string_view part = text.substr(at + 1, next == std::string_view::npos ? next : next - at - 1);
      if (const auto equals = part.find('='); equals != std::string_view::npos) {
        group = &startGroup(std::string(part.substr(0, equals)));
        part.remove_prefix(equals + 1);
      }
      const auto number = numberOf(part);
      if (!number || group == nullptr) throw fail("\"" + std::string(part) + "\" is not a number");
      group->push_back(*number);
      at = next;
    }
  }

  Light light() {
    Light light;
    light.type = type_;
    const bool sun = type_ == LightType::directional, coned = type_ == LightType::spot || type_ == LightType::disk;
    const bool sized = type_ == LightType::sphere || type_ == LightType::disk;
    if (!sun) light.position = vector(required("at"), "at");
    if (sun || coned) light.direction = direction(light.position);
    if (sized) light.radius = scalar(required("radius"), "radius", 0.0f);
    if (sun && has("angle-deg")) light.angle = kRadiansPerDegree * scalar(take("angle-deg"), "angle-deg", 0.0f, 90.0f);
    if (has("intensity")) readIntensity(light);
    if (coned) readCone(light);
    if (!sun && has("range")) {
      light.range = scalar(take("range"), "range", 0.0f);
      if (!(light.range > 0.0f)) throw fail("range must be above 0");
    }
    if (!groups_.empty()) throw fail("a " + kindName() + " has no \"" + groups_.begin()->first + "\"");
    return light;
  }

 private:
  Error fail(const std::string& what) const { return usageError(option_, what, kExample); }

  std::string kindName() const {
    return std::string(std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& kind) { return kind.second == type_; })->first);
  }

  void readKind(std::string_view name) {
    const auto* const kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& one) { return one.first == name; });
    if (kind == kKinds.end()) throw fail("\"" + std::string(name) + "\" is none of sun, point, spot, sphere, disk");
    type_ = kind->second;
  }

  std::vector<float>& startGroup(const std::string& key) {
    static const std::array<std::string_view, 8> kKeys{"at", "direction", "target", "radius", "angle-deg", "intensity", "cone-deg", "range"};
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) throw fail("unknown key \"" + key + "\"");
    const auto [place, fresh] = groups_.try_emplace(key);
    if (!fresh) throw fail("\"" + key + "\" is given twice");
    return place->second;
  }

  bool has(const std::string& key) const { return groups_.count(key) != 0; }
  std::vector<float> take(const std::string& key) { return std::move(groups_.extract(key).mapped()); }
  std::vector<float> required(const std::string& key) {
    if (!has(key)) throw fail("a " + kindName() + " needs \"" + key + "=\"");
    return take(key);
  }

  glm::vec3 vector(const std::vector<float>& values, const std::string& key) const {
    if (values.size() != 3) throw fail(key + " needs three numbers, not " + std::to_string(values.size()));
    return {values[0], values[1], values[2]};
  }

  float scalar(const std::vector<float>& values, const std::string& key, float least, float most = INFINITY) const {
    if (values.size() != 1) throw fail(key + " takes one number");
    if (!(values[0] >= least && values[0] <= most)) throw fail(key + " is out of range");
    return values[0];
  }

  glm::vec3 direction(glm::vec3 position) {
    const bool target = has("target");
    if (target == has("direction")) throw fail("a " + kindName() + " needs \"direction=\" or \"target=\", one of both");
    const std::string key = target ? "target" : "direction";
    glm::dvec3 way = glm::dvec3(vector(take(key), key)) - (target ? glm::dvec3(position) : glm::dvec3(0.0));
    const double length = glm::length(way);
    if (!(length > 0.0)) throw fail(target ? "target is where the light is" : "direction is zero");
    return glm::vec3(way / length);
  }

  void readIntensity(Light& light) {
    const std::vector<float> values = take("intensity");
    if (values.size() != 1 && values.size() != 3) throw fail("intensity takes one number or three");
    for (const float value : values)
      if (!(value >= 0.0f)) throw fail("intensity must not be negative");
    const float largest = *std::max_element(values.begin(), values.end());
    light.intensity = largest;
    if (values.size() == 3 && largest > 0.0f) light.color = glm::vec3(values[0], values[1], values[2]) / largest;
  }

  void readCone(Light& light) {
    glm::vec2 degrees = type_ == LightType::spot ? glm::vec2(0.0f, 45.0f) : kNoCone;
    if (has("cone-deg")) {
      const std::vector<float> values = take("cone-deg");
      if (values.size() != 2) throw fail("cone-deg takes two numbers");
      degrees = {values[0], values[1]};
      if (!(degrees.x >= 0.0f && degrees.x < degrees.y && degrees.y <= 90.0f)) throw fail("cone-deg is out of range");
    }
    light.innerConeAngle = kRadiansPerDegree * degrees.x;
    light.outerConeAngle = kRadiansPerDegree * degrees.y;
  }

  const std::string& option_;
  LightType type_ = LightType::directional;
  std::map<std::string, std::vector<float>> groups_;
};

std::string numbers(const char* key, std::initializer_list<float> values) {
  std::string text = std::string(",") + key + "=";
  for (const float value : values) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.7g", static_cast<double>(value));
    text += (text.back() == '=' ? "" : ",") + std::string(buffer);
  }
  return text;
}

std::string numbers(const char* key, glm::vec3 v) { return numbers(key, {v.x, v.y, v.z}); }

}  // namespace

Light parseLightSpec(const std::string& text, const std::string& option) { return LightParser(text, option).light(); }

std::string lightSpec(const Light& light) {
  const bool sun = light.type == LightType::directional, coned = light.type == LightType::spot || light.type == LightType::disk;
  std::string text(std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& kind) { return kind.second == light.type; })->first);
  if (!sun) text += numbers("at", light.position);
  if (sun || coned) text += numbers("direction", light.direction);
  if (light.type == LightType::sphere || light.type == LightType::disk) text += numbers("radius", {light.radius});
  if (sun) text += numbers("angle-deg", {std::min(light.angle / kRadiansPerDegree, 90.0f)});
  text += numbers("intensity", light.color * light.intensity);
  if (coned)
    text += numbers("cone-deg", {light.innerConeAngle / kRadiansPerDegree, std::min(light.outerConeAngle / kRadiansPerDegree, 90.0f)});
  if (!sun && std::isfinite(light.range)) text += numbers("range", {light.range});
  return text;
}

}  // namespace chiaro
