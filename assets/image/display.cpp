#include "assets/image/display.h"

#include <array>
#include <cmath>
#include <utility>

#include "assets/error.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {

ToneMap toneMapFromName(const std::string& name) {
  static constexpr std::array<std::pair<const char*, ToneMap>, 3> kNames{
      {{"neutral", ToneMap::neutral}, {"aces", ToneMap::aces}, {"clamp", ToneMap::clamp}}};
  for (const auto& [known, toneMap] : kNames)
    if (name == known) return toneMap;
  throw usageError("--tone-map", "unknown tone map \"" + name + "\"", "give neutral, aces or clamp");
}

glm::vec3 displayColor(glm::vec3 radiance, float exposure, ToneMap toneMap) {
  return lobe32::displayEncode(radiance, exposure, static_cast<int>(toneMap));
}

Image8 displayImage(const ImageRgba& radiance, float exposure, ToneMap toneMap) {
  Image8 image{radiance.width, radiance.height, {}};
  image.texels.reserve(4 * radiance.texels.size());
  for (const auto& texel : radiance.texels) {
    const glm::vec3 color = displayColor(glm::vec3(texel), exposure, toneMap);
    for (int i = 0; i < 3; ++i) {
      // NaN shows as black in 8 bits; the float picture keeps it.
      const float value = color[i] >= 0.0f ? color[i] : 0.0f;
      image.texels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * value)));
    }
    image.texels.push_back(255);
  }
  return image;
}

}  // namespace chiaro
