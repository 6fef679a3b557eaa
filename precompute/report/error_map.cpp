#include "precompute/report/error_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "precompute/report/metrics/magma.h"

namespace chiaro {
namespace {

using Color8 = std::array<std::uint8_t, 3>;
constexpr Color8 kUndefined{255, 0, 255};
constexpr Color8 kNoObject{48, 48, 48};

Color8 colorOf(double signedError) {
  const double amount = std::min(1.0, std::abs(signedError) / kErrorMapRange);
  const auto first = static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, 2.0 * amount)));
  const auto second = static_cast<std::uint8_t>(std::lround(255.0 * std::max(0.0, 2.0 * amount - 1.0)));
  return signedError > 0 ? Color8{first, second, 0} : Color8{0, second, first};
}

}  // namespace

Image8 errorMap(const ImageRgba& picture, const ImageRgba& reference, const DisplaySettings& display) {
  Image8 map{reference.width, reference.height, {}};
  map.texels.reserve(4 * reference.texels.size());
  for (std::size_t i = 0; i < reference.texels.size(); ++i) {
    const glm::vec4 &ours = picture.texels[i], &truth = reference.texels[i];
    const glm::vec3 error = displayColor(glm::vec3(ours), display.exposure, display.toneMap) -
                            displayColor(glm::vec3(truth), display.exposure, display.toneMap);
    const double mean = (static_cast<double>(error.r) + static_cast<double>(error.g) + static_cast<double>(error.b)) / 3.0;
    const bool undefined = !std::isfinite(mean) || !std::isfinite(truth.a);
    const Color8 color = undefined ? kUndefined : truth.a > 0.5f ? colorOf(mean) : kNoObject;
    map.texels.insert(map.texels.end(), {color[0], color[1], color[2], 255});
  }
  return map;
}

Image8 flipErrorMap(const MetricMap& flip, const ImageRgba& reference) {
  Image8 map{reference.width, reference.height, {}};
  map.texels.reserve(4 * reference.texels.size());
  for (std::size_t i = 0; i < reference.texels.size(); ++i) {
    const double value = flip.plane.values[i];
    const float coverage = reference.texels[i].a;
    const bool undefined = std::isnan(value) || !std::isfinite(coverage);
    const Color8 color = undefined ? kUndefined : coverage > 0.5f ? magma(value) : kNoObject;
    map.texels.insert(map.texels.end(), {color[0], color[1], color[2], 255});
  }
  return map;
}

}  // namespace chiaro
