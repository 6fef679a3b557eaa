#pragma once
/// What a visible fraction is asked of.

#include <glm/glm.hpp>
#include <vector>

#include "precompute/lobe_pattern.h"

namespace chiaro {

/// A von Mises-Fisher lobe with the directions it is integrated over; they all carry the same weight.
struct Lobe {
  glm::dvec3 axis{0.0, 0.0, 1.0};  ///< unit
  double sharpness = 1.0;
  std::vector<glm::vec3> directions{};
};

}  // namespace chiaro
