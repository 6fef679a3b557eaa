#include "precompute/material/material_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "assets/error.h"

namespace chiaro {
namespace {

using lobe64::Vec3;
using Fresnel = FitFamily::Fresnel;

constexpr const char* kJsonNames[] = {"cookTorrance", "beckmann", "blinnPhong", "ward", "ggx", "ashikhminShirley"};

/// Places in the one block of parameters: logarithms of both widths, the second's share, F90 or F0, then colours.
enum : std::size_t { kWidth, kWidth2, kShare, kEdge, kDiffuse, kSpecular = kDiffuse + 3, kCount = kSpecular + 3 };
using Parameters = std::array<double, kCount>;

Parameters parametersOf(const MaterialFit& fit) {
  return {std::log(fit.width), std::log(fit.width2), fit.share,      fit.f90,        fit.diffuse.x,
          fit.diffuse.y,       fit.diffuse.z,        fit.specular.x, fit.specular.y, fit.specular.z};
}

MaterialFit fitOf(const Parameters& p) {
  MaterialFit fit;
  fit.width = std::exp(p[kWidth]);
  fit.width2 = std::exp(p[kWidth2]);
  fit.share = p[kShare];
  fit.f90 = p[kEdge];
  fit.diffuse = Vec3(p[kDiffuse], p[kDiffuse + 1], p[kDiffuse + 2]);
  fit.specular = Vec3(p[kSpecular], p[kSpecular + 1], p[kSpecular + 2]);
  return fit;
}

/// F of one channel, and how it changes with the edge parameter and with the colour.
struct FresnelTerm {
  double value, byEdge, byColour;
};
FresnelTerm fresnelTerm(Fresnel kind, double edge, double colour, double w) {
  if (kind == Fresnel::none) return {colour, 0.0, 1.0};
  if (kind == Fresnel::scaled) return {colour * (edge + (1.0 - edge) * w), colour * (1.0 - w), edge + (1.0 - edge) * w};
  const double ramp = colour + (1.0 - colour) * w;
  return {edge * ramp, ramp, edge * (1.0 - w)};
}

/// What the metric makes of x = rho cos, and its slope.
double compressed(FitMetric metric, double x) { return metric == FitMetric::cosine ? x : std::log1p(std::max(x, 0.0)); }
double slope(FitMetric metric, double x) { return metric == FitMetric::cosine ? 1.0 : 1.0 / (1.0 + std::max(x, 0.0)); }

/// Residuals 3 i + c of sample i and channel c.
class Residuals : public ceres::CostFunction {
 public:
  Residuals(const std::vector<FitSample>& samples, const FitFamily& family, FitMetric metric, int lobes)
      : samples_(samples), family_(family), metric_(metric), lobes_(lobes) {
    set_num_residuals(static_cast<int>(3 * samples.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(kCount));
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const double* p = blocks[0];
    double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const FitSample& s = samples_[i];
      const Lobe first = lobeAt(p[kWidth], s, jacobian != nullptr),
                 second = lobes_ > 1 ? lobeAt(p[kWidth2], s, jacobian != nullptr) : Lobe{};
      const double lobe = (1.0 - p[kShare]) * first.value + p[kShare] * second.value;
      FresnelTerm f[3];
      for (std::size_t c = 0; c < 3; ++c) f[c] = fresnelTerm(family_.fresnel, p[kEdge], p[kSpecular + c], s.fresnel);
      std::size_t largest = 0;
      for (std::size_t c = 1; c < 3; ++c)
        if (f[c].value > f[largest].value) largest = c;
      const bool loses = family_.fresnel == Fresnel::schlick;
      const double left = loses ? 1.0 - f[largest].value : 1.0, root = std::sqrt(s.weight / 3.0);
      for (std::size_t c = 0; c < 3; ++c) {
        const double diffuse = p[kDiffuse + c] / lobe64::kPi, rho = diffuse * left + f[c].value * lobe, x = rho * s.wi.z;
        residuals[3 * i + c] = root * (compressed(metric_, x) - compressed(metric_, s.rho[static_cast<int>(c)] * s.wi.z));
        if (jacobian == nullptr) continue;
        double* row = jacobian + (3 * i + c) * kCount;
        const double scale = root * slope(metric_, x) * s.wi.z;
        std::fill(row, row + kCount, 0.0);
        row[kWidth] = scale * f[c].value * (1.0 - p[kShare]) * first.byLogWidth;
        row[kWidth2] = scale * f[c].value * p[kShare] * second.byLogWidth;
        row[kShare] = scale * f[c].value * (second.value - first.value);
        row[kEdge] = scale * (f[c].byEdge * lobe - (loses ? diffuse * f[largest].byEdge : 0.0));
        row[kDiffuse + c] = scale * left / lobe64::kPi;
        row[kSpecular + c] += scale * f[c].byColour * lobe;
        if (loses) row[kSpecular + largest] -= scale * diffuse * f[largest].byColour;
      }
    }
    return true;
  }

 private:
  struct Lobe {
    double value = 0.0, byLogWidth = 0.0;
  };
  Lobe lobeAt(double logWidth, const FitSample& s, bool derivative) const {
    constexpr double kStep = 1e-5;
    Lobe lobe{.value = family_.lobe(std::exp(logWidth), s.wo, s.wi), .byLogWidth = 0.0};
    if (derivative)
      lobe.byLogWidth =
          (family_.lobe(std::exp(logWidth + kStep), s.wo, s.wi) - family_.lobe(std::exp(logWidth - kStep), s.wo, s.wi)) /
          (2.0 * kStep);
    return lobe;
  }

  const std::vector<FitSample>& samples_;
  const FitFamily& family_;
  FitMetric metric_;
  int lobes_;
};

/// The best non-negative (a, b) of a x + b y ~ z from the sums of products.
struct TwoColumns {
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
  void add(double x, double y, double z, double weight) {
    xx += weight * x * x, xy += weight * x * y, yy += weight * y * y, xz += weight * x * z, yz += weight * y * z,
        zz += weight * z * z;
  }
  double error(double a, double b) const { return zz - 2.0 * (a * xz + b * yz) + a * a * xx + 2.0 * a * b * xy + b * b * yy; }
  std::array<double, 2> solve(double mostA, double mostB) const {
    const double determinant = xx * yy - xy * xy;
    if (determinant > 1e-12 * xx * yy) {
      const double a = (xz * yy - yz * xy) / determinant, b = (yz * xx - xz * xy) / determinant;
      if (a >= 0.0 && b >= 0.0 && a <= mostA && b <= mostB) return {a, b};
    }
    // On the edge of what is allowed: the best of its four sides.
    std::array<double, 2> best{0.0, 0.0};
    const auto consider = [&](double a, double b) {
      if (error(a, b) < error(best[0], best[1])) best = {a, b};
    };
    for (const double a : {0.0, mostA}) consider(a, yy > 0.0 ? std::clamp((yz - a * xy) / yy, 0.0, mostB) : 0.0);
    for (const double b : {0.0, mostB}) consider(xx > 0.0 ? std::clamp((xz - b * xy) / xx, 0.0, mostA) : 0.0, b);
    return best;
  }
};

double mostOf(Fresnel kind) { return kind == Fresnel::schlick ? 1.0 : 1e6; }

/// The colours that suit one width, by linear least squares: the metric is taken as linear about the data, and the diffuse part as whole.
MaterialFit linearFit(const std::vector<FitSample>& samples, const FitFamily& family, FitMetric metric, double width,
                      double edge) {
  MaterialFit fit;
  fit.width = fit.width2 = width;
  fit.f90 = edge;
  std::array<TwoColumns, 3> columns;
  for (const FitSample& s : samples) {
    const double lobe = family.lobe(width, s.wo, s.wi);
    // F is linear in the colour.
    const double constant = fresnelTerm(family.fresnel, edge, 0.0, s.fresnel).value,
                 by = fresnelTerm(family.fresnel, edge, 0.0, s.fresnel).byColour;
    for (std::size_t c = 0; c < 3; ++c) {
      const double data = s.rho[static_cast<int>(c)], k = s.wi.z * slope(metric, data * s.wi.z);
      columns[c].add(1.0 / lobe64::kPi, by * lobe, data - constant * lobe, s.weight * k * k);
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [a, b] = columns[c].solve(1.0, mostOf(family.fresnel));
    fit.diffuse[static_cast<int>(c)] = a;
    fit.specular[static_cast<int>(c)] = b;
  }
  return fit;
}

double rootMeanSquare(const std::vector<FitSample>& samples, const FitFamily& family, FitMetric metric, const MaterialFit& fit) {
  const Residuals residuals(samples, family, metric, 2);
  std::vector<double> values(3 * samples.size());
  const Parameters parameters = parametersOf(fit);
  const double* block = parameters.data();
  residuals.Evaluate(&block, values.data(), nullptr);
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum);
}

MaterialFit refined(const std::vector<FitSample>& samples, const FitFamily& family, const FitOptions& options,
                    const MaterialFit& start) {
  Parameters p = parametersOf(start);
  ceres::Problem::Options problemOptions;
  problemOptions.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  Residuals residuals(samples, family, options.metric, options.lobes);
  ceres::Problem problem(problemOptions);
  problem.AddResidualBlock(&residuals, nullptr, p.data());
  std::vector<int> fixed;
  const auto fix = [&](std::size_t at) { fixed.push_back(static_cast<int>(at)); };
  if (options.lobes < 2) fix(kWidth2), fix(kShare);
  if (family.fresnel == Fresnel::none || (family.fresnel == Fresnel::schlick && !options.fitF90)) fix(kEdge);
  if (!fixed.empty()) problem.SetManifold(p.data(), new ceres::SubsetManifold(static_cast<int>(kCount), fixed));
  const auto bound = [&](std::size_t at, double least, double most) {
    p[at] = std::clamp(p[at], least, most);
    problem.SetParameterLowerBound(p.data(), static_cast<int>(at), least);
    problem.SetParameterUpperBound(p.data(), static_cast<int>(at), most);
  };
  bound(kWidth, std::log(kLeastFitWidth), std::log(kMostFitWidth));
  bound(kWidth2, std::log(kLeastFitWidth), std::log(kMostFitWidth));
  bound(kShare, 0.0, 1.0);
  bound(kEdge, 0.0, 1.0);
  for (std::size_t c = 0; c < 3; ++c) bound(kDiffuse + c, 0.0, 1.0), bound(kSpecular + c, 0.0, mostOf(family.fresnel));
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;  // ten unknowns, tens of thousands of residuals
  solver.max_num_iterations = 60;
  solver.num_threads = 1;
  solver.function_tolerance = 1e-9;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable())
    throw Error(ExitCode::failed, family.name, "the fit fails: " + summary.message, "try another model with --model");
  MaterialFit fit = fitOf(p);
  if (options.lobes < 2) fit.width2 = fit.width, fit.share = 0.0;
  fit.error = rootMeanSquare(samples, family, options.metric, fit);
  return fit;
}

}  // namespace

const char* modelJsonName(int kind) { return kJsonNames[kind]; }

std::optional<int> modelFromJsonName(const std::string& name) {
  const auto* found = std::find(std::begin(kJsonNames), std::end(kJsonNames), name);
  if (found == std::end(kJsonNames)) return std::nullopt;
  return static_cast<int>(found - std::begin(kJsonNames));
}

FitFamily modelFamily(int kind) {
  const auto parameter = [kind](double width) {
    return lobe64::modelHasExponent(kind) ? std::clamp(2.0 / (width * width) - 1.0, lobe64::kMinExponent, lobe64::kMaxExponent)
                                          : width;
  };
  return {.name = kJsonNames[kind],
          .fresnel = Fresnel::schlick,
          .lobe =
              [kind, parameter](double width, const Vec3& wo, const Vec3& wi) {
                const double x = parameter(width);
                return wi.z > 0.0 ? lobe64::modelTimesCosine(lobe64::reflectanceModel(kind, x, x), wo, wi) / wi.z : 0.0;
              },
          .published = parameter};
}

MaterialFit fitMaterial(const std::vector<FitSample>& samples, const FitFamily& family, const FitOptions& options) {
  constexpr int kScan = 24;
  // A metal's F0 hides in the scale of other families: start low.
  const double edge = family.fresnel == Fresnel::scaled ? 0.1 : 1.0;
  std::vector<MaterialFit> scan;
  for (int i = 0; i < kScan; ++i) {
    const double width = kLeastFitWidth * std::pow(kMostFitWidth / kLeastFitWidth, static_cast<double>(i) / (kScan - 1));
    scan.push_back(linearFit(samples, family, options.metric, width, edge));
    scan.back().error = rootMeanSquare(samples, family, options.metric, scan.back());
  }
  // Starts: the least of the scan, no two of them neighbours.
  std::vector<std::size_t> order(scan.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scan[a].error < scan[b].error; });
  std::vector<std::size_t> starts;
  for (const std::size_t i : order) {
    const bool near =
        std::any_of(starts.begin(), starts.end(), [&](std::size_t j) { return std::max(i, j) - std::min(i, j) <= 2; });
    if (!near && starts.size() < static_cast<std::size_t>(options.starts)) starts.push_back(i);
  }
  MaterialFit best;
  best.error = std::numeric_limits<double>::infinity();
  const auto consider = [&](const MaterialFit& start, const FitOptions& with) {
    const MaterialFit fit = refined(samples, family, with, start);
    if (fit.error < best.error) best = fit;
  };
  FitOptions one = options;
  one.lobes = 1;
  for (const std::size_t i : starts) consider(scan[i], one);
  if (options.lobes > 1) {
    const MaterialFit single = best;
    for (const double ratio : {0.3, 3.0}) {
      MaterialFit start = single;
      start.width2 = std::clamp(single.width * ratio, kLeastFitWidth, kMostFitWidth);
      start.share = 0.3;
      consider(start, options);
    }
  }
  // Where F leaves nothing, the diffuse colour says nothing.
  const double largest = std::max(best.f0().x, std::max(best.f0().y, best.f0().z));
  if (family.fresnel == Fresnel::schlick && largest >= 1.0 - 1e-3) best.diffuse = Vec3(0.0);
  best.cosineError = rootMeanSquare(samples, family, FitMetric::cosine, best);
  return best;
}

ReflectanceFunction fittedReflectance(const FitFamily& family, const MaterialFit& fit) {
  return [family, fit](const Vec3& wo, const Vec3& wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return Vec3(0.0);
    const double w = lobe64::fresnelSchlickWeight(dot(wo, lobe64::halfVector(wo, wi)));
    double lobe = family.lobe(fit.width, wo, wi);
    if (fit.share > 0.0) lobe = (1.0 - fit.share) * lobe + fit.share * family.lobe(fit.width2, wo, wi);
    Vec3 f(0.0);
    for (int c = 0; c < 3; ++c) f[c] = fresnelTerm(family.fresnel, fit.f90, fit.specular[c], w).value;
    const double left = family.fresnel == Fresnel::schlick ? 1.0 - std::max(f.x, std::max(f.y, f.z)) : 1.0;
    return fit.diffuse * (left / lobe64::kPi) + f * lobe;
  };
}

}  // namespace chiaro
