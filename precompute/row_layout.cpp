#include "precompute/row_layout.h"

#include <algorithm>

#include "precompute/ssdf/ssdf.h"

namespace chiaro {
namespace {

// Sharpness 3, 10.5, 36.75, 128.6, and maps whose texels are about as wide as half a lobe.
const std::vector<VisibilityLevel> kLevels{{3.0f, 12}, {10.5f, 20}, {36.75f, 28}, {128.625f, 44}};
/// With levels, only lobes of half the last one's sharpness and more read the SSDF: two to three of their standard deviations.
constexpr float kJointClamp = 0.265f;
/// Of the stored distances: 2.7 texels of 64 x 64 (measured on the built-in scene: from .12 to .18 alike; without, the functions lose a sixth more). Between
/// coarser texels the bend would show.
float jointSoftness(int resolution) { return std::max(0.15f, 9.6f / static_cast<float>(resolution)); }

}  // namespace

TransferRows::Layout rowLayout(const BakeSettings& settings, const std::vector<glm::vec3>& directions, float directionSharpness) {
  const bool joint = settings.compression == Compression::joint;
  return {.resolution = settings.resolution,
          .samplingResolution = settings.samplingResolution,
          .clamp = joint ? kJointClamp : kMaxDistance,
          .softness = joint ? jointSoftness(settings.resolution) : 0.0f,
          .leastOccluder = settings.leastOccluder,
          .levels = joint ? kLevels : std::vector<VisibilityLevel>{},
          .directions = directions,
          .directionSharpness = directionSharpness};
}

}  // namespace chiaro
