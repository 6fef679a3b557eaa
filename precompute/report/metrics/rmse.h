#pragma once
/// Root mean square error and the decibels made of it.

#include "precompute/report/metrics/plane.h"

namespace chiaro {

/// Over the channels of the pixels that count. NaN when one of them is NaN or infinite, or none counts. Throws Error (failed) when the sizes differ.
double rootMeanSquareError(const ImageRgb& a, const ImageRgb& b, const PixelMask& mask = {});

/// 20 log10(peak / rmse) dB: infinity for equal pictures, NaN for NaN.
double peakSignalToNoise(double rmse, double peak = 1.0);

}  // namespace chiaro
