#pragma once
/// Filters of a picture along one axis at a time.

#include <functional>
#include <vector>

#include "precompute/report/metrics/plane.h"

namespace chiaro {

/// An odd number of weights, the middle one of the pixel itself.
using Taps = std::vector<double>;

/// weight(k) for k in [-radius, radius].
Taps tapsOf(int radius, const std::function<double(int)>& weight);
/// The same, divided by their sum.
Taps normalised(Taps taps);

/// What lies outside the picture: the nearest pixel of the border, or nothing, the weights left divided by their sum.
enum class Border { nearest, cut };

/// sum over k of taps[k] * plane(x + k - radius, y): not mirrored.
Plane filterAlongX(const Plane& plane, const Taps& taps, Border border, int threads);
Plane filterAlongY(const Plane& plane, const Taps& taps, Border border, int threads);

}  // namespace chiaro
