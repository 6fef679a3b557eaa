#pragma once
/// How far a clustered transfer is from what was traced.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "precompute/bake.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/transfer_rows.h"

namespace chiaro {

/// The figures of BakeReport::error (docs/programs.md), from 256 random vertices that are traced again:
///  * ssdf_rms_radians, ssdf_sign_share: the stored SSDF against the traced one (clamped alike), above the horizon.
///  * level_rms_<sharpness>: stored against traced prefiltered visibility, above the horizon.
///  * visible_fraction_mean_abs_<lambda>: of a normalised SG lobe about a random axis above the horizon (16 each), what a renderer
///    would look up against 512 traced rays, the vertex's horizon included; visible_fraction_uncompressed_...: the same from the traced rows.
std::vector<std::pair<std::string, double>> measureClusteredError(const RayScene& rays, const std::vector<Viewpoint>& viewpoints,
                                                                  const TransferRows& rows, const Transfer& transfer,
                                                                  const BakeSettings& settings, const std::function<void(double)>& progress);

}  // namespace chiaro
