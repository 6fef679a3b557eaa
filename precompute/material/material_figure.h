#pragma once
/// Data against fit, drawn.

#include "precompute/figure/figure.h"
#include "precompute/material/material_study.h"

namespace chiaro {

/// Luminance of rho (n.wi) over the half vector's angle, in the plane of incidence, half vectors leaning towards the viewer, for viewers at 0,
/// 30, 60 and 75 degrees; for a distribution alone, the distribution, its model and its mixture.
Figure materialFigure(const MaterialData& data, const MaterialStudy& study);

}  // namespace chiaro
