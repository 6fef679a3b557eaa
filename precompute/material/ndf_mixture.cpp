#include "precompute/material/ndf_mixture.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr double kMostSharpness = 1e6;

struct Point {
  double versine, value, weight;  ///< 1 - cos, the distribution over its peak, root of the solid angle's share
};

/// A lobe's amplitude is its square's parameter, so that it stays positive without a bound at 0 that catches lobes.
class Residuals : public ceres::CostFunction {
 public:
  Residuals(const std::vector<Point>& points, int count) : points_(points), count_(static_cast<std::size_t>(count)) {
    set_num_residuals(static_cast<int>(points.size()));
    mutable_parameter_block_sizes()->push_back(2 * count);
  }
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const double* p = blocks[0];
    for (std::size_t i = 0; i < points_.size(); ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < count_; ++k) {
        const double sharpness = std::exp(p[2 * k + 1]), lobe = std::exp(-sharpness * points_[i].versine),
                     amplitude = p[2 * k] * p[2 * k];
        sum += amplitude * lobe;
        if (jacobians == nullptr || jacobians[0] == nullptr) continue;
        double* row = jacobians[0] + i * 2 * count_;
        row[2 * k] = points_[i].weight * 2.0 * p[2 * k] * lobe;
        row[2 * k + 1] = -points_[i].weight * amplitude * lobe * sharpness * points_[i].versine;
      }
      residuals[i] = points_[i].weight * (sum - points_[i].value);
    }
    return true;
  }

 private:
  const std::vector<Point>& points_;
  std::size_t count_;
};

/// Where the distribution has fallen to half of its peak, from the outside.
double halfWidth(const std::function<double(double)>& ndf, double peak) {
  constexpr int kSteps = 20000;
  double last = 1e-4;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 1e-5 * std::pow(lobe64::kHalfPi / 1e-5, static_cast<double>(i) / kSteps);
    if (ndf(angle) >= 0.5 * peak) last = angle;
  }
  return last;
}

}  // namespace

NdfMixture fitNdfMixture(const std::function<double(double)>& ndf, int count) {
  constexpr int kPoints = 600;
  double peak = ndf(0.0);
  for (int i = 0; i <= kPoints; ++i) peak = std::max(peak, ndf(lobe64::kHalfPi * i / kPoints));
  for (int i = 0; i <= kPoints; ++i)
    peak = std::max(peak, ndf(1e-5 * std::pow(lobe64::kHalfPi / 1e-5, static_cast<double>(i) / kPoints)));
  const double half = halfWidth(ndf, peak);
  // Points grow linearly up to half the peak's width, then in proportion.
  std::vector<Point> points;
  const double top = std::log1p(lobe64::kHalfPi / half);
  double norm2 = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double u = (i + 0.5) / kPoints * top, angle = half * std::expm1(u), step = half * std::exp(u) * top / kPoints;
    const double s = std::sin(0.5 * angle), weight = std::sqrt(std::sin(angle) * step), value = ndf(angle) / peak;
    points.push_back({2.0 * s * s, value, weight});
    norm2 += weight * weight * value * value;
  }
  const double broad = std::log(2.0) / (1.0 - std::cos(half));  // one lobe of that half width
  NdfMixture best;
  best.error = std::numeric_limits<double>::infinity();
  for (const double ratio : {2.0, 4.0, 8.0}) {
    std::vector<double> p;
    for (int k = 0; k < count; ++k) {
      p.push_back(std::pow(0.4, k));
      p.push_back(std::log(std::min(broad * std::pow(ratio, count > 1 ? 0.5 - k : 0), kMostSharpness)));
    }
    Residuals residuals(points, count);
    ceres::Problem::Options problemOptions;
    problemOptions.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(problemOptions);
    problem.AddResidualBlock(&residuals, nullptr, p.data());
    for (int k = 0; k < count; ++k) {
      problem.SetParameterLowerBound(p.data(), 2 * k + 1, std::log(1e-3));
      problem.SetParameterUpperBound(p.data(), 2 * k + 1, std::log(kMostSharpness));
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.max_num_iterations = 200;
    solver.function_tolerance = 1e-12;
    solver.num_threads = 1;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable()) continue;
    const double error = std::sqrt(2.0 * summary.final_cost / norm2);
    if (!(error < best.error)) continue;
    best.error = error;
    best.lobes.clear();
    for (int k = 0; k < count; ++k) {
      const auto at = static_cast<std::size_t>(2 * k);
      best.lobes.push_back(lobe64::sphericalGaussian(lobe64::Vec3(0, 0, 1), std::exp(p[at + 1]), peak * p[at] * p[at]));
    }
  }
  if (best.lobes.empty()) throw Error(ExitCode::failed, "distribution", "no mixture fits it", "check that it falls from a peak");
  std::sort(best.lobes.begin(), best.lobes.end(), [](const auto& a, const auto& b) { return a.sharpness > b.sharpness; });
  return best;
}

}  // namespace chiaro
