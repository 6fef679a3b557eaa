#pragma once
/// An environment as a light: its radiance in any direction, and directions where it is bright.

#include <glm/glm.hpp>
#include <vector>

#include "assets/builtin/environment.h"

namespace chiaro::reference {

/// Radiance is bilinear between texel centres (columns wrap, the first and the last row continue to the pole), as on the GPU.
/// Directions are drawn by texel in proportion to (the mean of that bilinear radiance over the texel, its channels added) times the
/// texel's solid angle, and uniformly in solid angle within it.
class EnvironmentSampler {
 public:
  /// Keeps a reference to `environment`. `worldFromEnvironment`: a rotation.
  EnvironmentSampler(const Environment& environment, const glm::mat3& worldFromEnvironment);

  struct Light {
    glm::dvec3 radiance{0.0};
    double density = 0.0;  ///< of sample(), per steradian
  };
  /// Both at once, as finding the place in the image is most of the work. `direction` unit, in the world.
  Light at(glm::dvec3 direction) const;
  glm::dvec3 radiance(glm::dvec3 direction) const { return at(direction).radiance; }

  /// False where all is black (or empty): then nothing can be drawn and every density is 0.
  bool anyLight() const { return total_ > 0.0; }
  glm::dvec3 sample(glm::dvec2 random) const;

 private:
  glm::dvec2 texelCoordinates(glm::dvec3 direction) const;
  glm::dvec3 bilinear(glm::dvec2 texelCoordinates) const;
  double density(glm::dvec2 texelCoordinates) const;
  const float* cumulative(int row) const {
    return &columns_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(width_) + 1)];
  }

  const Environment* environment_;
  glm::dmat3 worldFromEnvironment_;
  int width_;
  int height_;
  double total_ = 0.0;
  std::vector<double> rows_;     ///< height + 1: share of the light above each row
  std::vector<float> columns_;   ///< height x (width + 1): the same within each row
  std::vector<double> cosines_;  ///< height + 1: of the polar angle at the upper edge of each row
};

}  // namespace chiaro::reference
