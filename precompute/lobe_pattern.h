#pragma once
/// A normalised SG lobe as stratified directions: what the truth is traced along and what stored maps are integrated with.

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Strata of the polar angle by the inverse of the cumulative distribution, turned on by the golden angle; neighbours beside each other, as packets of
/// them are traced faster.
class LobePattern {
 public:
  /// sharpness > 0.
  LobePattern(double sharpness, std::size_t count);

  /// The directions about `axis` (unit), the pattern turned by `turn` radians. A boundary is integrated with an error of about count^-3/4.
  void directions(glm::dvec3 axis, double turn, std::vector<glm::vec3>& out) const;
  double sharpness() const { return sharpness_; }

 private:
  double sharpness_;
  std::vector<glm::dvec3> local_;  ///< x, y across; z: 1 - cosine to the axis, which keeps its accuracy for sharp lobes
};

}  // namespace chiaro
