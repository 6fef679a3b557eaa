#pragma once
// The metrics of precompute/report/metrics once more, as slowly and plainly as their papers state them: two-dimensional windows, no
// separation, no shared code.

#include <vector>

#include "assets/image/image.h"

namespace chiaro::naive {

double ssim(const ImageRgb& a, const ImageRgb& b);                                                     // mean over whole windows
std::vector<double> flip(const ImageRgb& reference, const ImageRgb& test, double pixelsPerDegree);     // display-encoded
std::vector<double> hdrFlip(const ImageRgb& reference, const ImageRgb& test, double pixelsPerDegree);  // linear

}  // namespace chiaro::naive
