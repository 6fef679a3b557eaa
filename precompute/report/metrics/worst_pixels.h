#pragma once
/// The places of a picture that are most wrong.

#include <vector>

#include "precompute/report/metrics.h"

namespace chiaro {

struct WorstPixel {
  int x = 0, y = 0;           ///< from the top left
  double difference = 0.0;    ///< root of the mean square over the channels, display-encoded, as PictureDifference::rmse
  double bias = 0.0;          ///< mean of picture minus reference over the channels
};

/// At most `count` object pixels of the reference, the worst first, none within `apart` pixels (a side of the square about it) of a worse one, as neighbours
/// mostly err alike. Without the pixels that are not finite, and those that do not differ.
std::vector<WorstPixel> worstPixels(const ImageRgba& picture, const ImageRgba& reference, const DisplaySettings& display, std::size_t count, int apart);

}  // namespace chiaro
