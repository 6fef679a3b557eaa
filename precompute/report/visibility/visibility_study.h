#pragma once
/// The points of one scene where methods are measured, with the truth there: made once, asked any number of times.

#include "precompute/report/visibility/lobe_truth.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace chiaro {

/// One point where a method errs.
struct PointError {
  std::size_t point = 0;      ///< in the order of the study
  bool atVertex = false;
  std::size_t vertex = 0;     ///< of the prepared scene: the point itself, or the nearest corner
  glm::dvec3 position{0.0};   ///< metres, world space
  double error = 0.0;         ///< mean |error| over the axes and sharpnesses
  double worst = 0.0;         ///< mean |error| over the axes, of the sharpness with the largest
  double worstSharpness = 0.0;
};

class VisibilityStudy {
 public:
  /// scene: as prepareScene() leaves it; must outlive this. Throws Error where it has no surface.
  VisibilityStudy(const Scene& scene, const VisibilitySettings& settings, const ProgressHandler& progress);

  /// What methods are made from; of VisibilitySettings::resolution and ::terms, which a copy may change.
  const VisibilityInput& input() const { return input_; }
  /// Those at vertices first.
  const std::vector<SurfacePoint>& points() const { return truth_.points(); }
  std::vector<MethodError> errorsOf(const std::vector<const VisibilityMethod*>& methods, const ProgressHandler& progress) const;
  /// At most `count` points, the one with the largest PointError::error first.
  std::vector<PointError> worstPoints(const VisibilityMethod& method, std::size_t count, const ProgressHandler& progress) const;
  /// Sizes and truth; no methods.
  VisibilityComparison facts() const;

 private:
  const Scene& scene_;
  RayScene rays_;
  std::vector<Viewpoint> viewpoints_;
  std::size_t atVertices_ = 0;  ///< the first so many points; the others are inside triangles
  LobeTruth truth_;
  VisibilityInput input_;
};

}  // namespace chiaro
