#pragma once
/// FLIP, the difference that a person sees when two pictures are shown in turn.
///   Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images"
///   Andersson, Nilsson, Shirley, Akenine-Moller 2021, "Visualizing Errors in Rendered High Dynamic Range Images"

#include "precompute/report/metrics/plane.h"

namespace chiaro {

struct FlipSettings {
  /// Of visual angle. The papers' default: a screen .7 m and 3840 pixels wide, .7 m away.
  double pixelsPerDegree = 3840.0 * 3.14159265358979323846 / 180.0;
  int threads = 0;
};

/// Of display-encoded (sRGB) colours in [0,1] (clamped). 0 where equal, at most 1. Borders repeat. NaN where either picture is not finite; its neighbours
/// see black there in both. Throws Error (failed) when the sizes differ.
MetricMap ldrFlip(const ImageRgb& reference, const ImageRgb& test, const FlipSettings& settings = {});

/// Exposures of the HDR form: `count` of them, as powers of two, evenly from `start` to `stop`.
struct ExposureRange {
  double start = 0.0;
  double stop = 0.0;
  int count = 1;

  double at(int i) const { return count > 1 ? start + (stop - start) * i / (count - 1) : start; }
};

/// Longest range, in stops: what is darker than the brightest by more is never looked for.
inline constexpr double kMostStops = 32.0;

/// From the one that shows the brightest luminance of the reference at .85 to the one that shows the median there, after the tone map; a count of
/// max(2, ceil(stops)), as the paper has it. Over the finite pixels that count; a black reference has the one exposure 0. A negative channel is 0.
/// A median further below the brightest than kMostStops, or 0, is taken to be that far.
ExposureRange exposureRangeOf(const ImageRgb& reference, const PixelMask& mask = {});

struct HdrFlip {
  MetricMap map;  ///< at each pixel the largest of all exposures
  ExposureRange range;
};

/// Of linear radiance: FLIP after exposure, the ACES fit of Narkowicz (as the paper has it) and sRGB encoding, over the exposures of the range. The same
/// for radiance in any unit. Negative channels are 0; NaN and infinity as in ldrFlip(). Throws Error (failed) when the sizes differ.
HdrFlip hdrFlip(const ImageRgb& reference, const ImageRgb& test, const PixelMask& mask = {}, const FlipSettings& settings = {});

}  // namespace chiaro
