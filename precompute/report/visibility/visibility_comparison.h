#pragma once
/// The visible fraction of SG lobes by every way to store visibility, against traced rays, on counted bytes.

#include <memory>

#include "precompute/bake.h"
#include "precompute/report/visibility/lobe_sharpness.h"
#include "precompute/report/visibility/visibility_method.h"

namespace chiaro {

struct VisibilitySettings {
  int vertices = 250;        ///< measured, at random
  int points = 250;          ///< inside triangles, at random by area
  int rays = 4096;           ///< of the truth, a lobe
  int resolution = 64;       ///< octahedral texels a side, a multiple of 4
  int terms = 48;            ///< of the PCAs that are made here
  int basisVertices = 8192;  ///< at most so many vertices a basis is made from
  std::uint32_t seed = 0;
  int threads = 0;  ///< never changes the figures
};

struct MethodError {
  std::string name;
  StoredBytes bytes;
  double bytesPerVertex = 0.0;
  ErrorBySharpness atVertices{}, inTriangles{};  ///< NaN where no point was asked for
};

struct VisibilityComparison {
  std::size_t vertices = 0, triangles = 0;                  ///< of the scene
  std::size_t pointsAtVertices = 0, pointsInTriangles = 0;  ///< measured
  std::size_t basisVertices = 0;
  ErrorBySharpness truthNoise{};  ///< of the truth itself: half the mean difference of its two halves, all points
  ErrorBySharpness truthMean{};   ///< mean visible fraction, all points
  std::vector<MethodError> methods;
};

/// The methods of one scene, in the order of the report.
using MethodMaker = std::function<std::vector<std::unique_ptr<VisibilityMethod>>(const VisibilityInput&)>;

/// SH 25, 49, 100; Haar 24 (as many bytes as 48 weights), 48, 96; PCA of visibility and of both SSDFs; the SSDF of occluders uncompressed; no shadows.
std::vector<std::unique_ptr<VisibilityMethod>> baselineMethods(const VisibilityInput& input);

class VisibilityStudy;

/// The study's points, with the errors of all methods. Same figures for any number of threads. Throws Error.
VisibilityComparison compareVisibility(const VisibilityStudy& study, const MethodMaker& methods, const ProgressHandler& progress = {});

/// scene: as prepareScene() leaves it. At every point and axis the truth is the share of `rays` directions of the lobe that are above
/// the point's own normal and meet nothing. Every estimate is clamped to [0, 1]. Same figures for any number of threads. Throws Error.
VisibilityComparison compareVisibility(const Scene& scene, const MethodMaker& methods, const VisibilitySettings& settings,
                                       const ProgressHandler& progress = {});

}  // namespace chiaro
