#pragma once
/// A coarser frame to show while things move, on a driver that is too slow for the whole one.

#include "runtime/render/renderer.h"

namespace chiaro {

/// `full` itself where it is expected within `kPreviewMilliseconds`; else without supersampling and, in each direction, the
/// smallest whole fraction down to an eighth that is expected within it. `millisecondsPerSample` is of a shaded point, infinite
/// where nothing has been measured.
RenderSettings previewSettings(const RenderSettings& full, double millisecondsPerSample);

inline constexpr double kPreviewMilliseconds = 60.0;

/// Shaded points of a frame.
double sampleCount(const RenderSettings& settings);

}  // namespace chiaro
