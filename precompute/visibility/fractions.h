#pragma once
/// The visible fractions of a vertex: how much of each of a few fixed broad lobes arrives.

#include <cstdint>
#include <vector>

#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// `count` directions spread evenly over the sphere (spherical Fibonacci set): z_i = 1 - (2 i + 1) / count, phi_i = i * golden angle.
std::vector<glm::vec3> fibonacciDirections(int count);

class VisibleFractions {
 public:
  VisibleFractions(const OctahedralGrid& grid, const std::vector<glm::vec3>& directions, float sharpness);

  /// For lobe j about axis p_j, over the texels w on the axis' side of the horizon:
  ///
  ///   v_j = sum dOmega |dot(n, w)| G(w; p_j) V(w)  /  the same without V
  ///
  /// One-sided vertices have one side. A lobe that hardly reaches above it has no value of its own: it takes what the others say about
  /// the mirror image of its axis, so that interpolation over a triangle meets no invented number. fractions: #directions, in [0, 1].
  void operator()(const Viewpoint& viewpoint, const AlignedFloats& cosine, const TexelBits& above, const TexelBits& visible,
                  float* fractions) const;

 private:
  const OctahedralGrid& grid_;
  std::vector<glm::vec3> directions_;
  float sharpness_;
  std::size_t stride_;    ///< directions, rounded up to 16
  AlignedFloats lobes_;   ///< #texels by stride: dOmega G(texel; p_j)
};

}  // namespace chiaro
