#pragma once
/// Round SG lobes fitted to one view of a round reflectance model: rho (n.wi) over light directions wi, for a viewer in the xz plane, n = z.

#include <Eigen/Dense>
#include <vector>

#include "shaders/cpp/lobe.h"

namespace chiaro::slice {

/// The view at light directions with y >= 0 (the other half mirrors them), as quadrature.
struct Slice {
  double theta = 0.0;  ///< of the viewer, radians from n
  double width = 0.0;  ///< lobe64::modelWidth()
  double peak = 0.0;
  Eigen::ArrayXd x, y, z;
  Eigen::ArrayXd root;           ///< of the solid angle
  Eigen::ArrayXd weight;         ///< of a residual: `root`, more where little is reflected, see sampleSlice()
  Eigen::ArrayXd value, fresnel;  ///< rho (n.wi) and (1 - wo.wh)^5
};

/// parameter as lobe64::reflectanceModel() takes it. Squared residuals weigh 1 / (value / peak + floor)^power: (any, 0) is equation (11) of Wang et al.
/// 2009, which sees the peak alone; under light whose range is a thousand to one the tail shows as well.
struct Weighting {
  double floor = 1.0;
  double power = 0.0;
};
Slice sampleSlice(int kind, double parameter, double cosineOut, const Weighting& weighting = {});

/// Lobes as numbers of size one: singles in the plane of incidence (angle over width, ln(sharpness width^2), root of amplitude over peak), then pairs
/// mirrored about it, with an elevation over width after the angle.
struct Shape {
  int singles = 0, pairs = 0;
  int groups() const { return singles + pairs; }
  int size() const { return 3 * singles + 4 * pairs; }
  int first(int group) const { return group < singles ? 3 * group : 3 * singles + 4 * (group - singles); }
};

struct Lobe {
  double angle;  ///< from n away from the viewer, radians
  double elevation;
  double sharpness, amplitude;
};
Lobe lobeOf(const Shape& shape, const Slice& slice, const Eigen::VectorXd& p, int group);
/// side: 1, or -1 for the mirror image of a pair.
lobe64::Vec3 axisOf(const Lobe& lobe, double side);

/// Levenberg and Marquardt from `p`, held near `prior` by `pull`; returns the weighted squared relative error.
double refine(const Shape& shape, const Slice& slice, Eigen::VectorXd& p, const Eigen::VectorXd& prior, double pull, int steps);

/// The best of several starts.
Eigen::VectorXd fitFromNothing(const Shape& shape, const Slice& slice, double& error);

/// The split of each group's weight (the integral of its lobes) into what F0 scales and what Fresnel adds, neither negative.
std::vector<glm::dvec2> splitWeights(const Shape& shape, const Slice& slice, const Eigen::VectorXd& p);

}  // namespace chiaro::slice
