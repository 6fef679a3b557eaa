#pragma once
/// What is really visible of SG lobes at the points of a comparison, traced once for any number of methods.

#include <cstdint>
#include <functional>
#include <vector>

#include "precompute/report/visibility/lobe_sharpness.h"
#include "precompute/report/visibility/visibility_method.h"

namespace chiaro {

/// Random axes above the horizon of each point, and about each a normalised lobe of every kLobeSharpness.
class LobeTruth {
 public:
  static constexpr std::size_t kAxes = 16;

  /// Traces `raysPerLobe` directions of each lobe: the truth is the share of them that is above the point's own normal and meets nothing.
  /// progress: share done in [0, 1]. Same figures for any number of threads.
  LobeTruth(const RayScene& rays, std::vector<SurfacePoint> points, int raysPerLobe, std::uint32_t seed, int threads,
            const std::function<void(double)>& progress);

  const std::vector<SurfacePoint>& points() const { return points_; }
  /// Of the points from `first` to before `last`: mean visible fraction, and half the mean difference between two halves of the rays.
  ErrorBySharpness mean(std::size_t first, std::size_t last) const;
  ErrorBySharpness noise(std::size_t first, std::size_t last) const;

  /// Sums over the axes of each point of |estimate clamped to [0, 1] - truth|, in the order of points(), for each of `methods`.
  std::vector<std::vector<ErrorBySharpness>> errorSums(const std::vector<const VisibilityMethod*>& methods, int threads,
                                                       const std::function<void(double)>& progress) const;

 private:
  struct Axis {
    glm::dvec3 axis;
    ErrorBySharpness truth, noise;
    ErrorBySharpness turn;  ///< radians, of the pattern that methods integrate with
  };

  ErrorBySharpness meanOf(ErrorBySharpness Axis::*value, std::size_t first, std::size_t last) const;

  std::vector<SurfacePoint> points_;
  std::vector<Axis> axes_;  ///< #points by kAxes
};

/// Mean over the axes of the points from `first` to before `last`; NaN where there are none.
ErrorBySharpness meanError(const std::vector<ErrorBySharpness>& sums, std::size_t first, std::size_t last);

}  // namespace chiaro
