#include "runtime/brdf/slice_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chiaro::slice {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using lobe64::Vec3;

ArrayXd distance2(const Slice& slice, const Vec3& axis) {
  return (slice.x - axis.x).square() + (slice.y - axis.y).square() + (slice.z - axis.z).square();
}

/// Weighted squared relative error; residuals and their slopes on request.
double residuals(const Shape& shape, const Slice& slice, const VectorXd& p, double norm, VectorXd* residual, MatrixXd* slopes) {
  ArrayXd sum = -slice.value;
  if (slopes != nullptr) slopes->setZero(slice.value.size(), shape.size());
  const ArrayXd scale = slice.weight / norm;
  for (int g = 0; g < shape.groups(); ++g) {
    const Lobe lobe = lobeOf(shape, slice, p, g);
    const int at = shape.first(g);
    const bool pair = g >= shape.singles;
    for (int side = 0; side <= (pair ? 1 : 0); ++side) {
      const double sign = side == 0 ? 1.0 : -1.0;
      const ArrayXd d2 = distance2(slice, axisOf(lobe, sign));
      const ArrayXd shapeValue = (-0.5 * lobe.sharpness * d2).exp();
      const ArrayXd value = lobe.amplitude * shapeValue;
      sum += value;
      if (slopes == nullptr) continue;
      const double ce = std::cos(lobe.elevation), se = std::sin(lobe.elevation), ca = std::cos(lobe.angle),
                   sa = std::sin(lobe.angle);
      slopes->col(at).array() += value * lobe.sharpness * slice.width * (-ca * ce * slice.x - sa * ce * slice.z) * scale;
      if (pair)
        slopes->col(at + 1).array() +=
            value * lobe.sharpness * slice.width * (sa * se * slice.x + sign * ce * slice.y - ca * se * slice.z) * scale;
      slopes->col(at + 1 + pair).array() += value * (-0.5 * lobe.sharpness * d2) * scale;
      slopes->col(at + 2 + pair).array() += 2.0 * p[at + 2 + pair] * slice.peak * shapeValue * scale;
    }
  }
  const VectorXd r = (sum * scale).matrix();
  if (residual != nullptr) *residual = r;
  return r.squaredNorm();
}

/// Strung along the plane of incidence, `spread` deviations of the stretched lobe from end to end.
VectorXd firstGuess(const Shape& shape, const Slice& slice, double spread, double tail) {
  const double deviation = std::sqrt(2.0) * std::min(1.0, 0.35 / slice.width), c = std::max(std::cos(slice.theta), 0.1);
  const int count = shape.groups();
  VectorXd p(shape.size());
  for (int g = 0; g < count; ++g) {
    // Singles at the even places of the string, pairs between them.
    const double place = g < shape.singles ? (shape.singles > 1 ? 2.0 * g / (shape.singles - 1) - 1.0 : 0.0)
                                           : (2.0 * (g - shape.singles) - (shape.pairs - 1)) * 0.4;
    const bool pair = g >= shape.singles, end = count > 1 && !pair && (g == 0 || g == shape.singles - 1);
    const int at = shape.first(g);
    p[at] = std::min(place * spread * deviation, (1.5 - slice.theta) / slice.width);
    if (pair) p[at + 1] = 0.3 * c * deviation;
    p[at + 1 + pair] = std::log(1.0 / (2.0 * c * c) * (end ? tail : 1.0));
    p[at + 2 + pair] = std::sqrt(0.5 * std::exp(-0.5 * std::pow(place * spread, 2)) + 0.01) * (pair ? 0.6 : 1.0);
  }
  return p;
}

/// min |B x - g|^2, x >= 0, by cyclic coordinate descent on the normal equations (Franc, Hlavac and Navara 2005).
VectorXd nonNegativeLeastSquares(const MatrixXd& gram, const VectorXd& right, VectorXd x) {
  VectorXd gradient = gram * x - right;
  for (int sweep = 0; sweep < 400; ++sweep) {
    double largest = 0.0;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (!(gram(k, k) > 0.0)) continue;
      const double moved = std::max(0.0, x[k] - gradient[k] / gram(k, k)) - x[k];
      if (moved == 0.0) continue;
      x[k] += moved;
      largest = std::max(largest, moved * moved * gram(k, k));
      gradient += moved * gram.col(k);
    }
    if (largest < 1e-14) break;
  }
  return x;
}

}  // namespace

Slice sampleSlice(int kind, double parameter, double cosineOut, const Weighting& weighting) {
  // Slopes of half vectors, radius on a scale that is linear in the peak and logarithmic in the tail.
  constexpr int kRadii = 56, kAzimuths = 28;
  constexpr double kLinear = 0.5;
  const auto model = lobe64::reflectanceModel(kind, parameter, parameter);
  Slice slice;
  slice.theta = std::acos(cosineOut);
  slice.width = lobe64::modelWidth(kind, model.x);
  const Vec3 wo(std::sin(slice.theta), 0.0, cosineOut);
  const double top = std::log1p((kind == lobe64::kGgx ? 60.0 : 6.0) / std::min(1.0, 1.5 * slice.width) / kLinear);
  std::vector<double> columns[6];
  for (int i = 0; i < kRadii; ++i) {
    const double u = (i + 0.5) / kRadii * top, r = kLinear * std::expm1(u), step = kLinear * std::exp(u) * top / kRadii;
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = (j + 0.5) / kAzimuths * lobe64::kPi;
      const double sx = slice.width * r * std::cos(phi), sy = slice.width * r * std::sin(phi),
                   hz = 1.0 / std::sqrt(1.0 + sx * sx + sy * sy);
      const Vec3 wh(sx * hz, sy * hz, hz);
      const double c = dot(wo, wh);
      if (c <= 1e-6) continue;
      const Vec3 wi = 2.0 * c * wh - wo;
      if (wi.z <= 0.0) continue;
      const double solidAngle = 4.0 * c * slice.width * slice.width * r * step * (2.0 * lobe64::kPi / kAzimuths) * hz * hz * hz;
      const double row[6] = {
          wi.x, wi.y, wi.z, std::sqrt(solidAngle), lobe64::modelTimesCosine(model, wo, wi), lobe64::fresnelSchlickWeight(c)};
      for (int k = 0; k < 6; ++k) columns[k].push_back(row[k]);
    }
  }
  const auto array = [&](int k) {
    return ArrayXd(Eigen::Map<const ArrayXd>(columns[k].data(), static_cast<Eigen::Index>(columns[k].size())));
  };
  slice.x = array(0), slice.y = array(1), slice.z = array(2), slice.root = array(3), slice.value = array(4),
  slice.fresnel = array(5);
  slice.peak = slice.value.maxCoeff();
  slice.weight = slice.root * (slice.value / slice.peak + weighting.floor).pow(-0.5 * weighting.power);
  return slice;
}

Lobe lobeOf(const Shape& shape, const Slice& slice, const VectorXd& p, int group) {
  const int at = shape.first(group);
  const bool pair = group >= shape.singles;
  return {slice.theta + p[at] * slice.width, pair ? p[at + 1] * slice.width : 0.0,
          std::exp(p[at + 1 + pair]) / (slice.width * slice.width), p[at + 2 + pair] * p[at + 2 + pair] * slice.peak};
}

Vec3 axisOf(const Lobe& lobe, double side) {
  return Vec3(-std::sin(lobe.angle) * std::cos(lobe.elevation), side * std::sin(lobe.elevation),
              std::cos(lobe.angle) * std::cos(lobe.elevation));
}

double refine(const Shape& shape, const Slice& slice, VectorXd& p, const VectorXd& prior, double pull, int steps) {
  const double norm = std::sqrt((slice.value * slice.weight).square().sum());
  const auto cost = [&](const VectorXd& at) {
    return residuals(shape, slice, at, norm, nullptr, nullptr) + pull * (at - prior).squaredNorm();
  };
  VectorXd r;
  MatrixXd slopes;
  double damping = 1e-3, now = cost(p);
  for (int step = 0; step < steps; ++step) {
    residuals(shape, slice, p, norm, &r, &slopes);
    MatrixXd normal = slopes.transpose() * slopes;
    const VectorXd gradient = slopes.transpose() * r + pull * (p - prior);
    normal.diagonal().array() += pull;
    const double before = now, mean = normal.diagonal().mean();
    bool better = false;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      MatrixXd damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-4 * mean).matrix();
      VectorXd next = p - damped.ldlt().solve(gradient);
      for (int g = 0; g < shape.groups(); ++g) {  // no lobe broader than a hemisphere's worth, none far beyond the horizon
        const int at = shape.first(g) + 1 + (g >= shape.singles);
        next[at] = std::max(next[at], std::log(0.5 * slice.width * slice.width));
        next[at - 1 - (g >= shape.singles)] = std::min(next[at - 1 - (g >= shape.singles)], (1.75 - slice.theta) / slice.width);
      }
      const double value = cost(next);
      if (value < now) {
        p = next;
        now = value;
        damping = std::max(0.3 * damping, 1e-9);
        better = true;
      } else {
        damping *= 4.0;
      }
    }
    if (!better || before - now < 1e-4 * now) break;
  }
  return residuals(shape, slice, p, norm, nullptr, nullptr);
}

VectorXd fitFromNothing(const Shape& shape, const Slice& slice, double& error) {
  VectorXd best;
  error = std::numeric_limits<double>::infinity();
  for (const double spread : {1.2, 1.8, 2.5})
    for (const double tail : {1.0, 0.1}) {
      VectorXd p = firstGuess(shape, slice, spread, tail);
      const double e = refine(shape, slice, p, p, 1e-9, 200);
      if (e < error) error = e, best = p;
    }
  return best;
}

std::vector<glm::dvec2> splitWeights(const Shape& shape, const Slice& slice, const VectorXd& p) {
  const int groups = shape.groups();
  MatrixXd basis(slice.value.size(), groups);
  VectorXd whole(groups);
  for (int g = 0; g < groups; ++g) {
    const Lobe lobe = lobeOf(shape, slice, p, g);
    const bool pair = g >= shape.singles;
    ArrayXd value = (-0.5 * lobe.sharpness * distance2(slice, axisOf(lobe, 1.0))).exp();
    if (pair) value += (-0.5 * lobe.sharpness * distance2(slice, axisOf(lobe, -1.0))).exp();
    const double integral = lobe64::sgUnitIntegral(lobe.sharpness) * (pair ? 2.0 : 1.0);
    basis.col(g) = (value * slice.weight / integral).matrix();
    whole[g] = lobe.amplitude * integral;
  }
  // Once more with the albedo as a further wish, a percent of it as dear as a squared error of 1e-3: it goes to the broad lobes, which pay least.
  const auto refit = [&](const ArrayXd& value, const VectorXd& from) {
    const double albedo = (value * slice.root.square()).sum();
    if (!(albedo > 0.0)) return VectorXd(VectorXd::Zero(groups));
    const double wish = 10.0 * (value * slice.weight).square().sum() / (albedo * albedo);
    const MatrixXd gram = (basis.transpose() * basis).array() + wish;
    const VectorXd right = (basis.transpose() * (value * slice.weight).matrix()).array() + wish * albedo;
    return nonNegativeLeastSquares(gram, right, from);
  };
  whole = refit(slice.value, whole);
  // Fresnel's part is fitted alike; the rest is F0's, so that both together stay the best fit for F = 1.
  const VectorXd fresnel = refit(slice.value * slice.fresnel, 0.1 * whole);
  std::vector<glm::dvec2> weights(static_cast<std::size_t>(groups));
  for (int g = 0; g < groups; ++g) {
    const double part = std::min(fresnel[g], whole[g]);
    weights[static_cast<std::size_t>(g)] = {whole[g] - part, part};
  }
  return weights;
}

}  // namespace chiaro::slice
