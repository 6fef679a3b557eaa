#include "runtime/brdf/reflectance_table.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "runtime/parallel.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using lobe64::Vec3;

constexpr double kLeastCosine = 0.03;  // grazing views below 88 degrees are taken as that

/// rho (n.wi) of one view at light directions with y >= 0 (the other half mirrors them), with quadrature weights.
struct Slice {
  double theta = 0.0, width = 0.0, peak = 0.0;
  ArrayXd x, y, z;
  ArrayXd root;  // of the solid angle
  ArrayXd value, fresnel;
};

Slice sampleSlice(int kind, double parameter, double cosineOut) {
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
  return slice;
}

/// Lobes as numbers of size one: singles (angle over width, ln(sharpness width^2), root of amplitude over peak), then pairs with an
/// elevation over width after the angle.
struct Shape {
  int singles = 0, pairs = 0;
  int groups() const { return singles + pairs; }
  int size() const { return 3 * singles + 4 * pairs; }
  int first(int group) const { return group < singles ? 3 * group : 3 * singles + 4 * (group - singles); }
};

struct Lobe {
  double angle, elevation, sharpness, amplitude;  // angle from n away from the viewer
};

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

ArrayXd distance2(const Slice& slice, const Vec3& axis) {
  return (slice.x - axis.x).square() + (slice.y - axis.y).square() + (slice.z - axis.z).square();
}

/// Squared relative error; residuals and their slopes on request.
double residuals(const Shape& shape, const Slice& slice, const VectorXd& p, double norm, VectorXd* residual, MatrixXd* slopes) {
  ArrayXd sum = -slice.value;
  if (slopes != nullptr) slopes->setZero(slice.value.size(), shape.size());
  const ArrayXd scale = slice.root / norm;
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

/// Levenberg and Marquardt from `p`, held near `prior` by `pull`; returns the squared relative error.
double refine(const Shape& shape, const Slice& slice, VectorXd& p, const VectorXd& prior, double pull, int steps) {
  const double norm = std::sqrt((slice.value * slice.root).square().sum());
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

/// The best of several starts.
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

double widthAt(int i, int count) {
  const double least = std::sqrt(lobe64::kMinTableWidth), most = std::sqrt(lobe64::kMaxTableWidth);
  return std::pow(least + (most - least) * i / (count - 1), 2);
}
double cosineAt(int j, int count) { return std::max(std::pow(static_cast<double>(j) / (count - 1), 2), kLeastCosine); }
double parameterOf(int kind, double width) {
  return lobe64::modelHasExponent(kind) ? std::max(2.0 / (width * width) - 1.0, 1.0) : width;
}

constexpr Shape kTableShape{5, 2};
// Of a neighbour: far below the errors fitted, enough to keep idle lobes in place. These pulls and the view that a table starts from were found by
// trial: with others some neighbours come to share out the work differently, and what lies between them suffers.
double pullOf(int kind) { return kind == lobe64::kGgx ? 3e-4 : 1e-3; }
constexpr double kStartColumn = 14.0 / 24.0;

/// The split of each group's weight (the integral of its lobes) into what F0 scales and what Fresnel adds.
void splitWeights(const Slice& slice, const VectorXd& p, std::vector<glm::dvec2>& weights) {
  const int groups = kTableShape.groups();
  MatrixXd basis(slice.value.size(), groups);
  VectorXd whole(groups);
  for (int g = 0; g < groups; ++g) {
    const Lobe lobe = lobeOf(kTableShape, slice, p, g);
    const bool pair = g >= kTableShape.singles;
    ArrayXd value = (-0.5 * lobe.sharpness * distance2(slice, axisOf(lobe, 1.0))).exp();
    if (pair) value += (-0.5 * lobe.sharpness * distance2(slice, axisOf(lobe, -1.0))).exp();
    const double integral = lobe64::sgUnitIntegral(lobe.sharpness) * (pair ? 2.0 : 1.0);
    basis.col(g) = (value * slice.root / integral).matrix();
    whole[g] = lobe.amplitude * integral;
  }
  // Once more with the albedo as a further wish, a percent of it as dear as a squared error of 1e-3: it goes to the broad lobes, which pay least.
  const auto refit = [&](const ArrayXd& value, const VectorXd& from) {
    const double albedo = (value * slice.root.square()).sum();
    if (!(albedo > 0.0)) return VectorXd(VectorXd::Zero(groups));
    const double wish = 10.0 * (value * slice.root).square().sum() / (albedo * albedo);
    const MatrixXd gram = (basis.transpose() * basis).array() + wish;
    const VectorXd right = (basis.transpose() * (value * slice.root).matrix()).array() + wish * albedo;
    return nonNegativeLeastSquares(gram, right, from);
  };
  whole = refit(slice.value, whole);
  // Fresnel's part is fitted alike; the rest is F0's, so that both together stay the best fit for F = 1.
  const VectorXd fresnel = refit(slice.value * slice.fresnel, 0.1 * whole);
  for (int g = 0; g < groups; ++g) {
    const double part = std::min(fresnel[g], whole[g]);
    weights[static_cast<std::size_t>(g)] = {whole[g] - part, part};
  }
}

}  // namespace

ReflectanceTable makeReflectanceTable(int kind, int widthCount, int cosineCount, int threads) {
  ReflectanceTable table{kind, widthCount, cosineCount, {}};
  const int layer = widthCount * cosineCount;
  table.entries.resize(static_cast<std::size_t>(layer) * static_cast<std::size_t>(lobe64::kReflectanceEntries));
  const auto sliceAt = [&](int i, int j) {
    return sampleSlice(kind, parameterOf(kind, widthAt(i, widthCount)), cosineAt(j, cosineCount));
  };

  const auto store = [&](int i, int j, const Slice& slice, const VectorXd& p) {
    std::vector<glm::dvec2> weights(static_cast<std::size_t>(kTableShape.groups()));
    splitWeights(slice, p, weights);
    const auto entry = [&](int k) -> glm::vec4& {
      return table.entries[static_cast<std::size_t>((k * cosineCount + j) * widthCount + i)];
    };
    glm::vec4 elevations(0.0f);
    for (int g = 0; g < kTableShape.groups(); ++g) {
      const Lobe lobe = lobeOf(kTableShape, slice, p, g);
      const double each = g < kTableShape.singles ? 1.0 : 0.5;
      const glm::dvec2 weight = weights[static_cast<std::size_t>(g)] * each;
      entry(g) = glm::vec4(glm::dvec4(p[kTableShape.first(g)], std::log2(lobe.sharpness * slice.width * slice.width), weight));
      if (g >= kTableShape.singles) elevations[g - kTableShape.singles] = static_cast<float>(lobe.elevation / slice.width);
    }
    entry(kTableShape.groups()) = elevations;
  };

  // From one well-conditioned view of the sharpest row, each texel from its neighbours in the row before and in its own, so that the same
  // lobe does the same work everywhere and entries interpolate. The two halves of a row are independent.
  std::vector<VectorXd> row(static_cast<std::size_t>(cosineCount));
  const auto at = [&](int j) -> VectorXd& { return row[static_cast<std::size_t>(j)]; };
  const int start = static_cast<int>(std::lround(kStartColumn * (cosineCount - 1)));
  for (int i = 0; i < widthCount; ++i) {
    const auto fit = [&](int j, const VectorXd& prior) {
      const Slice slice = sliceAt(i, j);
      at(j) = prior;
      refine(kTableShape, slice, at(j), prior, pullOf(kind), 40);
      store(i, j, slice, at(j));
    };
    if (i == 0) {
      double ignored = 0.0;
      at(start) = fitFromNothing(kTableShape, sliceAt(0, start), ignored);
    }
    fit(start, VectorXd(at(start)));
    parallelFor(2, threads, [&](int half) {
      const int step = half == 0 ? -1 : 1;
      for (int j = start + step; j >= 0 && j < cosineCount; j += step)
        fit(j, i == 0 ? at(j - step) : VectorXd(0.5 * (at(j - step) + at(j))));
    });
  }
  return table;
}

const ReflectanceTable& reflectanceTableOf(int kind) {
  static std::mutex mutex;
  static std::map<int, ReflectanceTable> tables;
  const std::lock_guard lock(mutex);
  auto found = tables.find(kind);
  if (found == tables.end()) found = tables.emplace(kind, makeReflectanceTable(kind)).first;
  return found->second;
}

std::vector<SliceLobe> reflectanceLobes(const ReflectanceTable& table, double width, double cosineOut) {
  const glm::dvec2 coordinate =
      lobe64::reflectanceTableCoordinate(width, cosineOut) * lobe64::Vec2(table.widthCount - 1, table.cosineCount - 1);
  const int i = std::clamp(static_cast<int>(coordinate.x), 0, table.widthCount - 2),
            j = std::clamp(static_cast<int>(coordinate.y), 0, table.cosineCount - 2);
  const glm::dvec2 f = coordinate - glm::dvec2(i, j);
  const auto entry = [&](int k) {
    const auto texel = [&](int di, int dj) {
      return glm::dvec4(table.entries[static_cast<std::size_t>((k * table.cosineCount + j + dj) * table.widthCount + i + di)]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
  };
  const Vec3 n(0, 0, 1), x(1, 0, 0), y(0, 1, 0);
  const glm::dvec4 elevations = entry(kTableShape.groups());
  std::vector<SliceLobe> lobes;
  for (int g = 0; g < kTableShape.groups(); ++g)
    for (int side = 0; side <= (g < kTableShape.singles ? 0 : 1); ++side) {
      const double elevation = g < kTableShape.singles ? 0.0 : elevations[g - kTableShape.singles] * (side == 0 ? 1.0 : -1.0);
      const auto lobe = lobe64::reflectanceTableLobe(entry(g), elevation, n, x, y, cosineOut, width);
      lobes.push_back({lobe.axis, lobe.sharpness, lobe.weight, lobe.fresnelWeight});
    }
  return lobes;
}

std::vector<SliceLobe> fitSliceLobes(int kind, double parameter, double cosineOut, int count) {
  const Shape shape{count, 0};
  const Slice slice = sampleSlice(kind, parameter, cosineOut);
  double error = 0.0;
  const VectorXd p = fitFromNothing(shape, slice, error);
  std::vector<SliceLobe> lobes;
  for (int g = 0; g < count; ++g) {
    const Lobe lobe = lobeOf(shape, slice, p, g);
    lobes.push_back({axisOf(lobe, 1.0), lobe.sharpness, lobe.amplitude * lobe64::sgUnitIntegral(lobe.sharpness), 0.0});
  }
  return lobes;
}

}  // namespace chiaro
