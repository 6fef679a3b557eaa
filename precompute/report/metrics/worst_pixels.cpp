#include "precompute/report/metrics/worst_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace chiaro {
namespace {

glm::dvec3 displayed(const glm::vec4& texel, const DisplaySettings& display) { return displayColor(glm::vec3(texel), display.exposure, display.toneMap); }

}  // namespace

std::vector<WorstPixel> worstPixels(const ImageRgba& picture, const ImageRgba& reference, const DisplaySettings& display, std::size_t count, int apart) {
  std::vector<WorstPixel> all;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      if (!(reference.at(x, y).a > 0.5f)) continue;
      const glm::dvec3 error = displayed(picture.at(x, y), display) - displayed(reference.at(x, y), display);
      const double difference = std::sqrt(glm::dot(error, error) / 3.0);
      if (difference > 0.0 && std::isfinite(difference)) all.push_back({.x = x, .y = y, .difference = difference, .bias = (error.x + error.y + error.z) / 3.0});
    }
  std::stable_sort(all.begin(), all.end(), [](const WorstPixel& a, const WorstPixel& b) { return a.difference > b.difference; });
  std::vector<WorstPixel> worst;
  for (const auto& one : all) {
    if (worst.size() >= count) break;
    const bool near = std::any_of(worst.begin(), worst.end(), [&](const WorstPixel& other) { return std::max(std::abs(one.x - other.x), std::abs(one.y - other.y)) <= apart; });
    if (!near) worst.push_back(one);
  }
  return worst;
}

}  // namespace chiaro
