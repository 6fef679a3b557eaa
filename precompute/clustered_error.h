#pragma once
/// How far a clustered transfer is from what was traced.

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "precompute/bake.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/transfer_rows.h"

namespace chiaro {

/// The figures of BakeReport::error (docs/programs.md), from 256 random vertices (768 with a target error) that are traced again, once for however many transfers:
///  * ssdf_rms_radians, ssdf_sign_share: the stored SSDF against the traced one (clamped alike), above the horizon.
///  * level_rms_<sharpness>: stored against traced prefiltered visibility, above the horizon.
///  * visible_fraction_mean_abs_<lambda>: of a normalised SG lobe about a random axis above the horizon (16 each), what a renderer
///    would look up against 512 traced rays, the vertex's horizon included; visible_fraction_uncompressed_...: the same from the traced rows.
class ClusteredTruth {
 public:
  /// rows, viewpoints: must outlive this.
  ClusteredTruth(const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const TransferRows& rows, const BakeSettings& settings,
                 const std::function<void(double)>& progress);

  std::vector<std::pair<std::string, double>> errorOf(const Transfer& transfer) const;

  static constexpr std::array kSharpness{3, 10, 30, 100, 300, 1000, 3000};

 private:
  /// Lobes of each sharpness about one axis.
  struct Axis {
    glm::dvec3 axis;
    std::array<double, kSharpness.size()> aboveHorizon, visible;  ///< shares of the lobe
  };

  const std::vector<Viewpoint>& viewpoints_;
  const TransferRows& rows_;
  int threads_;
  std::vector<std::uint32_t> vertices_;
  std::vector<float> exact_;            ///< #vertices_ rows
  std::vector<std::vector<Axis>> axes_;  ///< of each vertex
};

}  // namespace chiaro
