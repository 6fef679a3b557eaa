#pragma once
/// Orthonormal two-dimensional Haar wavelets (non-standard decomposition) and the cube map they are made of.

#include <glm/glm.hpp>

#include "precompute/visibility/octahedral_grid.h"

namespace chiaro {

/// In place, `side` a power of two, row-major. Coefficient 0 is the mean times `side`.
void haarForward(float* image, int side);
void haarInverse(float* image, int side);

/// Six faces of side^2 texels: +x, -x, +y, -y, +z, -z; columns and rows along the next two axes (y and z on the faces of x).
struct CubeGrid {
  /// side: a power of two, at least 4.
  explicit CubeGrid(int side);

  int side;
  std::size_t texelCount;
  AlignedFloats x, y, z;  ///< #texels; unit directions of the texel centres

  std::size_t texelAt(glm::vec3 direction) const;
};

}  // namespace chiaro
