#include "assets/scene/reflectance.h"

#include <algorithm>
#include <cmath>

namespace chiaro {

const std::vector<std::string>& reflectanceNames() {
  static const std::vector<std::string> kNames{"ggx", "cookTorrance", "beckmann", "blinnPhong", "ward", "ashikhminShirley"};
  return kNames;
}

std::string reflectanceNameList() {
  std::string all;
  for (const auto& name : reflectanceNames()) all += (all.empty() ? "" : ", ") + name;
  return all;
}

std::optional<Reflectance> reflectanceFromName(const std::string& name) {
  const auto& names = reflectanceNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Reflectance>(found - names.begin());
}

float alphaFromExponent(float exponent) { return std::sqrt(2.0f / (exponent + 2.0f)); }
float exponentFromAlpha(float alpha) { return 2.0f / (alpha * alpha) - 2.0f; }

}  // namespace chiaro
