#include "precompute/mesh/transfer_probe.h"

#include <cmath>

namespace chiaro {

CoarseSsdf TransferProbe::trace(const Viewpoint& viewpoint, Scratch& scratch) const {
  texelsAbove(grid_, viewpoint.normal, scratch.cosine, scratch.above);
  scratch.rays += traceVisibility(rays_, grid_, viewpoint, scratch.above, scratch.visible);
  scratch.transform(viewpoint.normal, scratch.cosine, scratch.above, scratch.visible, viewpoint.doubleSided, scratch.distances.data());
  CoarseSsdf ssdf(grid_.texelCount);
  for (std::size_t t = 0; t < grid_.texelCount; ++t)
    ssdf[t] = static_cast<std::int8_t>(std::lrint(127.0f / kMaxDistance * scratch.distances[grid_.rowMajor[t]]));
  return ssdf;
}

double TransferProbe::wrongShare(const Viewpoint& viewpoint, std::span<const glm::vec3> planes, std::span<const WeightedSsdf> corners,
                                 Scratch& scratch) const {
  texelsAbove(grid_, viewpoint.normal, scratch.cosine, scratch.above);
  scratch.rays += traceVisibility(rays_, grid_, viewpoint, scratch.above, scratch.visible);
  double wrong = 0.0, all = 0.0;
  for (std::size_t t = 0; t < grid_.texelCount; ++t) {
    const bool above = texelBit(scratch.above.data(), t);
    if (!above && !viewpoint.doubleSided) continue;
    bool counts = true;
    for (const auto& plane : planes) counts = counts && (glm::dot(plane, grid_.direction(t)) > 0.0f) == above;
    if (!counts) continue;
    float distance = 0.0f;
    for (const auto& corner : corners) distance += corner.weight * static_cast<float>((*corner.ssdf)[t]);
    const double solidAngle = static_cast<double>(grid_.solidAngle[t]);
    all += solidAngle;
    if ((distance > 0.0f) != texelBit(scratch.visible.data(), t)) wrong += solidAngle;
  }
  return all > 0.0 ? wrong / all : 0.0;
}

}  // namespace chiaro
