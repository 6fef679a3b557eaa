#pragma once
/// Equation (11) of Wang et al. 2009's supplement: squared error of rho^R (n.wi)(n.wo) over both hemispheres, over the square of the truth.

#include <functional>
#include <vector>

#include "shaders/cpp/lobe.h"

namespace chiaro {

/// rho^R (n.wi) of one view, as a function of the light direction.
using Slice = std::function<double(const lobe64::Vec3& wi)>;
/// Makes the slice of a view.
using Reconstruction = std::function<Slice(const lobe64::Vec3& wo)>;

struct SliceError {
  double error2 = 0.0, norm2 = 0.0;  ///< over light directions
  double relative() const { return error2 / norm2; }
};

/// How finely to integrate.
struct Quadrature {
  int views = 40, viewAzimuths = 6;  ///< azimuths of the viewer for models that are not round, over a quarter
  int radii = 96, azimuths = 48;     ///< half vectors, over half the azimuth for round models
};

/// One view; half vectors are sampled in slopes, densely at the peak, so that a sharp lobe costs what a broad one does.
SliceError sliceError(const lobe64::ReflectanceModel& model, const lobe64::Vec3& wo, const Slice& slice,
                      const Quadrature& quadrature);

/// Equation (11) over views from the normal to `widest` radians, pi/2 for all.
double viewError(const lobe64::ReflectanceModel& model, const Reconstruction& reconstruction, double widest,
                 const Quadrature& quadrature);

struct GaussRule {
  std::vector<double> node, weight;
};
/// Gauss-Legendre on [from, to].
GaussRule gaussLegendre(int count, double from, double to);

}  // namespace chiaro
