#pragma once
/// A picture of where another picture is wrong.

#include "precompute/report/metrics.h"
#include "precompute/report/metrics/plane.h"

namespace chiaro {

/// The difference (mean over channels, display-encoded) at which the map's colours end.
inline constexpr double kErrorMapRange = 0.1;

/// Black where equal; red to yellow where `picture` is too bright, blue to cyan where it is too dark, full at
/// +-kErrorMapRange; magenta where either is undefined; dark grey where the reference shows no object.
Image8 errorMap(const ImageRgba& picture, const ImageRgba& reference, const DisplaySettings& display);

/// A map of FLIP in magma, 0 to 1; magenta where it is NaN, dark grey where the reference shows no object.
Image8 flipErrorMap(const MetricMap& flip, const ImageRgba& reference);

}  // namespace chiaro
