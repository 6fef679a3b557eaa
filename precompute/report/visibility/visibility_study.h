#pragma once
/// The points of one scene where methods are measured, with the truth there: made once, asked any number of times.

#include "precompute/report/visibility/lobe_truth.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace chiaro {

class VisibilityStudy {
 public:
  /// scene: as prepareScene() leaves it; must outlive this. Throws Error where it has no surface.
  VisibilityStudy(const Scene& scene, const VisibilitySettings& settings, const ProgressHandler& progress);

  /// What methods are made from; of VisibilitySettings::resolution and ::terms, which a copy may change.
  const VisibilityInput& input() const { return input_; }
  std::vector<MethodError> errorsOf(const std::vector<const VisibilityMethod*>& methods, const ProgressHandler& progress) const;
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
