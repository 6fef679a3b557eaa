#include "precompute/transfer_lookup.h"

#include <algorithm>

namespace chiaro {

double visibleShare(const float* row, int resolution, const std::vector<VisibilityLevel>& levels, float softness, glm::vec3 axis, double sharpness) {
  const auto fromSsdf = [&] { return lobe64::ssdfVisibleFraction(lobe64::ssdfExpanded(static_cast<double>(sampleOctahedral(row, resolution, axis)), static_cast<double>(softness)), sharpness); };
  if (levels.empty()) return fromSsdf();
  const double ratio = levels.size() > 1 ? static_cast<double>(levels[1].sharpness / levels[0].sharpness) : 2.0;
  const auto source = lobe64::visibilitySource(sharpness, static_cast<int>(levels.size()), static_cast<double>(levels[0].sharpness), ratio);
  const auto fromLevel = [&](int index) {
    const float* map = row + static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution);
    for (int l = 0; l < index; ++l) {
      const auto side = static_cast<std::size_t>(levels[static_cast<std::size_t>(l)].resolution);
      map += side * side;
    }
    return std::clamp(static_cast<double>(sampleOctahedral(map, levels[static_cast<std::size_t>(index)].resolution, axis)), 0.0, 1.0);
  };
  double share = 0.0;
  if (source.ssdf < 1.0) {
    share = fromLevel(source.level);
    if (source.next > 0.0) share += source.next * (fromLevel(source.level + 1) - share);
  }
  return source.ssdf > 0.0 ? share + source.ssdf * (fromSsdf() - share) : share;
}

}  // namespace chiaro
