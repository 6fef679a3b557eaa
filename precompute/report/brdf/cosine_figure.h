#pragma once
#include "precompute/figure/figure.h"

namespace chiaro {

/// Supplement, figure 1: relative L2 error over the sphere of the clamped cosine as spherical Gaussians, SH and ZH, by the number of terms.
Figure cosineFigure();

}  // namespace chiaro
