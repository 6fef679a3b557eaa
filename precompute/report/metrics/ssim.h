#pragma once
/// Structural similarity: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity".

#include "precompute/report/metrics/plane.h"

namespace chiaro {

/// Of display-encoded colours in [0,1] (clamped), by luminance alone as in the authors' program: Y = .299 R + .587 G + .114 B of the encoded
/// channels. An 11x11 Gaussian window of standard deviation 1.5, K1 = .01, K2 = .03, range 1, alpha = beta = gamma = 1. Values in [-1,1], 1 where equal;
/// symmetric. meanOf() takes windows that lie in the picture (margin 5). Of smaller pictures, and at borders, windows are cut and weighted anew.
/// NaN where either picture is not finite; windows of its neighbours take black there in both. Throws Error (failed) when the sizes differ.
MetricMap ssim(const ImageRgb& a, const ImageRgb& b, int threads = 0);

}  // namespace chiaro
