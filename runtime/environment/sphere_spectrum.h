#pragma once
/// An equirectangular map as spherical harmonics, where convolution with a spherical Gaussian is one factor a band.
///
/// Why not sum kernels: the bands a level needs fall with its sharpness (band l is damped by about exp(-l(l+1)/(2 sharpness))),
/// so every level costs a short transform, none depends on another, and each is exact to 1e-7 of its brightest value.

#include <Eigen/Dense>
#include <vector>

#include "assets/image/image.h"

namespace chiaro {

/// Bands 0..bandCount-1 of three channels. Order m: rows l = m..bandCount-1, columns Re r,g,b then Im r,g,b of the coefficient
/// of Y_lm = P_lm(cos theta) e^{i m phi}, orthonormal on the sphere; phi = 2 pi u, theta = pi v (u, v: image coordinates in [0,1]).
/// Negative orders are the conjugates, as the map is real.
struct SphereSpectrum {
  int bandCount = 0;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6>> orders;
};

/// rho_l of a unit-integral SG of this sharpness, I_{l+1/2} / I_{1/2}, for l = 0 until it falls below `cutoff` (ALGORITHMS 1.8).
std::vector<double> sgBandFactors(double sharpness, double cutoff = 1e-7);

/// The map is taken as bilinear between texel centres (held constant beyond the first and last row's centres). Its mean over
/// the sphere is kept to 1e-5 (Fejer quadrature in theta). `map` must not be empty.
SphereSpectrum analyse(const ImageRgb& map, int bandCount, int threads);

/// A smooth function on a latitude-longitude grid: texel (i,j) sits at u = (i+.5)/width, v = (j+.5)/height, height = width/2.
class SphereGrid {
 public:
  explicit SphereGrid(int height);
  int width() const { return width_; }
  int height() const { return height_; }
  /// Three channels of texel (i,j).
  float* texel(int i, int j) { return &values_[offset(i, j)]; }
  const float* texel(int i, int j) const { return &values_[offset(i, j)]; }
  /// Fills the border of two texels that interpolation needs (wraps in u, crosses the poles in v). Call after writing.
  void closeBorder();
  /// Cubic Lagrange interpolation. u and v in [0,1].
  glm::vec3 interpolate(float u, float v) const;

 private:
  static constexpr int kBorder = 2;
  std::size_t offset(int i, int j) const {
    return 3 * (static_cast<std::size_t>(j + kBorder) * static_cast<std::size_t>(width_ + 2 * kBorder) +
                static_cast<std::size_t>(i + kBorder));
  }
  int width_;
  int height_;
  std::vector<float> values_;
};

/// The function with band l scaled by bandFactors[l] (bands beyond the list are dropped) on a grid of `height` rows;
/// height must be even and at least the number of bands used. Border closed.
SphereGrid synthesise(const SphereSpectrum& spectrum, const std::vector<double>& bandFactors, int height, int threads);

}  // namespace chiaro
