#pragma once
/// The metrics of a comparison that follow what a person sees, with their maps.

#include "precompute/report/metrics.h"
#include "precompute/report/metrics/flip.h"
#include "precompute/report/metrics/plane.h"

namespace chiaro {

/// Means over the object pixels (those that the reference covers by more than half; background belongs to the windows of their neighbours). NaN when one of
/// them is not finite in either picture. The reference's own noise is in all of them.
struct PerceptualDifference {
  double ssim = 0.0;     ///< of display-encoded colours, 1 where equal
  double flip = 0.0;     ///< LDR, after the report's own exposure and tone map, 0 where equal
  double hdrFlip = 0.0;  ///< of radiance, 0 where equal
  ExposureRange range;   ///< of hdrFlip, from the object pixels of the reference
  MetricMap flipMap, hdrFlipMap;
};

/// Throws Error (failed) when the sizes differ.
PerceptualDifference comparePerceptually(const ImageRgba& picture, const ImageRgba& reference, const DisplaySettings& display,
                                         int threads);

}  // namespace chiaro
