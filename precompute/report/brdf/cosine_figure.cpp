#include "precompute/report/brdf/cosine_figure.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "precompute/report/brdf/view_error.h"

namespace chiaro {
namespace {

const double kNorm2 = 2.0 * lobe64::kPi / 3.0;  // of the clamped cosine

double leastOf(const std::function<double(double)>& f, double low, double high, double& at) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kScan = 24;  // there may be more than one valley
  double best = low, least = f(low);
  for (int i = 1; i <= kScan; ++i)
    if (const double here = low + (high - low) * i / kScan, value = f(here); value < least) least = value, best = here;
  double a = std::max(low, best - (high - low) / kScan), b = std::min(high, best + (high - low) / kScan);
  double x = b - kGolden * (b - a), y = a + kGolden * (b - a), fx = f(x), fy = f(y);
  for (int i = 0; i < 30; ++i) {
    if (fx < fy)
      b = y, y = x, fy = fx, x = b - kGolden * (b - a), fx = f(x);
    else
      a = x, x = y, fx = fy, y = a + kGolden * (b - a), fy = f(y);
  }
  at = 0.5 * (a + b);
  return f(at);
}

/// Signed lobes on the axis whose sharpnesses are `ratio` apart: amplitudes by least squares, the first sharpness by search.
double axialError(int count, double ratio) {
  const GaussRule below = gaussLegendre(48, -1.0, 0.0), above = gaussLegendre(48, 0.0, 1.0);
  const auto error2 = [&](double logSharpness) {
    Eigen::MatrixXd basis(96, count);
    Eigen::VectorXd target(96);
    for (int i = 0; i < 96; ++i) {
      const GaussRule& rule = i < 48 ? below : above;
      const double z = rule.node[static_cast<std::size_t>(i % 48)],
                   root = std::sqrt(rule.weight[static_cast<std::size_t>(i % 48)] * lobe64::kTwoPi);
      target[i] = root * std::max(z, 0.0);
      for (int k = 0; k < count; ++k) basis(i, k) = root * std::exp(std::exp(logSharpness) * std::pow(ratio, k) * (z - 1.0));
    }
    const Eigen::VectorXd amplitudes = basis.colPivHouseholderQr().solve(target);
    return (basis * amplitudes - target).squaredNorm();
  };
  double at = 0.0;
  return std::sqrt(leastOf(error2, std::log(0.3), std::log(6.0), at) / kNorm2);
}

/// `count` equal lobes on a cone about the axis, amplitude positive.
double ringError(int count) {
  const GaussRule below = gaussLegendre(24, -1.0, 0.0), above = gaussLegendre(24, 0.0, 1.0);
  constexpr int kAzimuths = 24;  // over one lobe's share, mirrored
  const auto error2 = [&](double tilt, double sharpness) {
    double gg = 0.0, gf = 0.0;
    for (int i = 0; i < 48; ++i) {
      const GaussRule& rule = i < 24 ? below : above;
      const double z = rule.node[static_cast<std::size_t>(i % 24)], s = std::sqrt(1.0 - z * z),
                   weight = rule.weight[static_cast<std::size_t>(i % 24)] * lobe64::kTwoPi / kAzimuths;
      for (int j = 0; j < kAzimuths; ++j) {
        const double phi = (j + 0.5) / kAzimuths * lobe64::kPi / count;
        double sum = 0.0;
        for (int k = 0; k < count; ++k)
          sum +=
              std::exp(sharpness * (std::cos(tilt) * z + std::sin(tilt) * s * std::cos(phi - lobe64::kTwoPi * k / count) - 1.0));
        gg += weight * sum * sum;
        gf += weight * sum * std::max(z, 0.0);
      }
    }
    return kNorm2 - gf * gf / gg;
  };
  double tilt = 0.0, ignored = 0.0;
  const double best = leastOf(
      [&](double t) { return leastOf([&](double l) { return error2(t, std::exp(l)); }, 0.5, 2.5, ignored); }, 0.3, 1.0, tilt);
  return std::sqrt(best / kNorm2);
}

}  // namespace

Figure cosineFigure() {
  Figure figure{.id = "cosine",
                .title = "The clamped cosine, by the number of terms",
                .xLabel = "terms (SG lobes; order of SH and ZH)",
                .yLabel = "relative L2 error over the sphere",
                .note = {},
                .logX = false,
                .logY = true,
                .curves = {}};
  Curve axial{"SG on the axis, signed", {}, {}}, ring{"SG on a cone, positive", {}, {}}, sh{"SH", {}, {}, true},
      zh{"ZH, one lobe", {}, {}, true};
  for (int count = 1; count <= 4; ++count) {
    axial.x.push_back(count);
    axial.y.push_back(axialError(count, count == 4 ? 1.5 : 2.0));
  }
  for (int count = 3; count <= 5; ++count) {
    ring.x.push_back(count);
    ring.y.push_back(ringError(count));
  }
  const GaussRule rule = gaussLegendre(32, 0.0, 1.0);
  double kept = 0.0;
  for (int l = 0; l < 12; ++l) {
    double projection = 0.0;  // of the clamped cosine on band l: 2 pi times the integral of z P_l(z)
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      double before = 0.0, value = 1.0;
      for (int k = 0; k < l; ++k) {
        const double next = ((2 * k + 1) * rule.node[i] * value - k * before) / (k + 1);
        before = value;
        value = next;
      }
      projection += rule.weight[i] * rule.node[i] * value * lobe64::kTwoPi;
    }
    kept += projection * projection * (2 * l + 1) / lobe64::kFourPi;
    const double error = std::sqrt(std::max(kNorm2 - kept, 0.0) / kNorm2);
    sh.x.push_back(l + 1), sh.y.push_back(error);
    zh.x.push_back(l + 1), zh.y.push_back(error);
  }
  figure.curves = {axial, ring, sh, zh};
  figure.note =
      "Sharpnesses on the axis are 2 apart (1.5 for four), or amplitudes grow without bound. Positive lobes on the axis gain "
      "nothing over one: "
      "gains need other signs or other axes. The target is symmetric about one axis, so a single zonal lobe of an order reaches "
      "the SH projection of that order.";
  return figure;
}

}  // namespace chiaro
