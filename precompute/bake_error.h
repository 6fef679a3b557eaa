#pragma once
/// How far what is stored is from what was traced.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "precompute/bake.h"
#include "precompute/compression/pca.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// Everything a bake knows of its vertices before it throws the large parts away.
struct TracedSignal {
  const OctahedralGrid* grid = nullptr;
  const RayScene* rays = nullptr;
  const std::vector<Viewpoint>* viewpoints = nullptr;
  const RowBlocks* ssdf = nullptr;  ///< #vertices by #texels, row-major texels
  float step = 0.0f;                ///< radians of one of its units
};

/// The figures of BakeReport::error. progress: share done in [0, 1], one thread at a time.
///  * ssdf_rms_radians: stored against traced SSDF, all vertices, the whole sphere by solid angle. ssdf_discarded_rms_radians: the
///    same predicted from the energy of the components left out.
///  * ssdf_sign_share: share of the solid angle where the stored sign is wrong, all vertices, above the horizon (double-sided: everywhere).
///  * ssdf_quantisation_rms_radians: stored against the same terms unrounded, a random 1024 vertices.
///  * visible_fraction_mean_abs_<lambda>: of a normalised SG lobe about a random axis above the horizon (double-sided: anywhere), the
///    half-space estimate from the stored SSDF against 256 traced rays drawn from the lobe; 256 random vertices, 16 axes each. Beyond the
///    horizon the truth is the mirror image of the axis' side, as the vertex's own horizon is no part of the SSDF.
///    visible_fraction_uncompressed_mean_abs_<lambda>: the same from the SSDF before compression, which is the part of the error that no
///    number of terms removes.
std::vector<std::pair<std::string, double>> measureBakeError(const TracedSignal& traced, const Pca& pca, const Transfer& transfer,
                                                             const BakeSettings& settings,
                                                             const std::function<void(double)>& progress = {});

}  // namespace chiaro
