#pragma once
/// A normalised SG lobe as stratified directions: what the truth is traced along and what stored maps are integrated with.

#include <cstddef>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "precompute/lobe_samples.h"

namespace chiaro {

/// A von Mises-Fisher lobe with the directions it is integrated over; they all carry the same weight.
struct Lobe {
  glm::dvec3 axis{0.0, 0.0, 1.0};  ///< unit
  double sharpness = 1.0;
  std::vector<glm::vec3> directions{};
};

/// Strata of the polar angle by the inverse of the cumulative distribution, turned on by the golden angle.
class LobePattern {
 public:
  /// sharpness > 0.
  LobePattern(double sharpness, std::size_t count);

  /// The directions about `axis`, the pattern turned by `turn` radians. A boundary is integrated with an error of about count^-3/4.
  void directions(glm::dvec3 axis, double turn, std::vector<glm::vec3>& out) const;
  double sharpness() const { return sharpness_; }

 private:
  double sharpness_;
  std::vector<glm::dvec3> local_;  ///< x, y across; z: 1 - cosine to the axis, which keeps its accuracy for sharp lobes
};

}  // namespace chiaro
