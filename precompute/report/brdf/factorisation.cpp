#include "precompute/report/brdf/factorisation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "precompute/report/brdf/view_error.h"

namespace chiaro {
namespace {

using Eigen::MatrixXd;
using lobe64::Vec3;

/// Squares of the singular values of `block`, each `times` times.
void addSquares(std::vector<double>& all, const MatrixXd& block, int times) {
  const bool wide = block.cols() > block.rows();
  const MatrixXd gram = wide ? MatrixXd(block * block.transpose()) : MatrixXd(block.transpose() * block);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(gram, Eigen::EigenvaluesOnly);
  for (const double value : solver.eigenvalues())
    for (int i = 0; i < times; ++i) all.push_back(std::max(value, 0.0));
}

std::vector<double> errorsOf(std::vector<double> squares, const std::vector<int>& terms) {
  std::sort(squares.begin(), squares.end(), std::greater<>());
  double total = 0.0;
  for (const double s : squares) total += s;
  std::vector<double> errors;
  for (const int count : terms) {
    double left = 0.0;  // from the small end: the sum of what is dropped keeps its digits
    for (std::size_t k = squares.size(); k > static_cast<std::size_t>(count); --k) left += squares[k - 1];
    errors.push_back(left / total);
  }
  return errors;
}

std::vector<double> roundSquares(const RoundReflectance& timesCosine, double widestIn, double widestOut, int polar, int azimuths) {
  const GaussRule in = gaussLegendre(polar, std::cos(widestIn), 1.0), out = gaussLegendre(polar, std::cos(widestOut), 1.0);
  const int half = azimuths / 2;
  // Even in azimuth: a cosine transform over [0, pi]. Orthonormal, so that squares of blocks add up to the square of the whole.
  MatrixXd transform(half + 1, half + 1);
  for (int k = 0; k <= half; ++k)
    for (int j = 0; j <= half; ++j)
      transform(k, j) = std::cos(lobe64::kPi * k * j / half) * (j == 0 || j == half ? 1.0 : 2.0) / azimuths;
  std::vector<MatrixXd> blocks(static_cast<std::size_t>(half + 1), MatrixXd(polar, polar));
  MatrixXd values(half + 1, polar);
  for (int o = 0; o < polar; ++o) {
    const double zo = out.node[static_cast<std::size_t>(o)];
    const Vec3 wo(std::sqrt((1.0 - zo) * (1.0 + zo)), 0.0, zo);
    for (int i = 0; i < polar; ++i) {
      const double zi = in.node[static_cast<std::size_t>(i)], s = std::sqrt((1.0 - zi) * (1.0 + zi));
      const double weight = zo * std::sqrt(in.weight[static_cast<std::size_t>(i)] * out.weight[static_cast<std::size_t>(o)]);
      for (int j = 0; j <= half; ++j) {
        const double phi = lobe64::kPi * j / half;
        const double value = timesCosine(wo, Vec3(s * std::cos(phi), s * std::sin(phi), zi));
        values(j, i) = std::isnan(value) ? 0.0 : weight * value;
      }
    }
    const MatrixXd spectrum = transform * values;
    for (int k = 0; k <= half; ++k) blocks[static_cast<std::size_t>(k)].col(o) = spectrum.row(k).transpose();
  }
  std::vector<double> squares;
  for (int k = 0; k <= half; ++k) addSquares(squares, blocks[static_cast<std::size_t>(k)], k == 0 || k == half ? 1 : 2);
  return squares;
}

/// Mirror symmetric in x and y when both directions are mirrored: directions of a quarter, in four combinations of parities.
std::vector<double> mirroredSquares(const lobe64::ReflectanceModel& model, double widest, int polar, int azimuths) {
  const GaussRule in = gaussLegendre(polar, 0.0, 1.0), out = gaussLegendre(polar, std::cos(widest), 1.0);
  const int quarter = azimuths / 4, size = polar * quarter;
  const auto direction = [&](const GaussRule& rule, int at) {
    const double z = rule.node[static_cast<std::size_t>(at / quarter)], s = std::sqrt((1.0 - z) * (1.0 + z));
    const double phi = (at % quarter + 0.5) / quarter * lobe64::kHalfPi;
    return Vec3(s * std::cos(phi), s * std::sin(phi), z);
  };
  std::vector<MatrixXd> blocks(4, MatrixXd(size, size));
  for (int o = 0; o < size; ++o) {
    const Vec3 wo = direction(out, o);
    for (int i = 0; i < size; ++i) {
      const Vec3 wi = direction(in, i);
      const double weight =
          wo.z * std::sqrt(in.weight[static_cast<std::size_t>(i / quarter)] * out.weight[static_cast<std::size_t>(o / quarter)]);
      double f[4];
      for (int q = 0; q < 4; ++q)
        f[q] = weight * lobe64::modelTimesCosine(model, wo, Vec3(q & 1 ? -wi.x : wi.x, q & 2 ? -wi.y : wi.y, wi.z));
      for (int p = 0; p < 4; ++p) {
        const double sx = p & 1 ? -1.0 : 1.0, sy = p & 2 ? -1.0 : 1.0;
        blocks[static_cast<std::size_t>(p)](i, o) = f[0] + sx * f[1] + sy * f[2] + sx * sy * f[3];
      }
    }
  }
  std::vector<double> squares;
  for (const MatrixXd& block : blocks) addSquares(squares, block, 1);
  return squares;
}

}  // namespace

std::vector<double> factorisationErrors(const lobe64::ReflectanceModel& model, double widest, int polar, int azimuths,
                                        const std::vector<int>& terms) {
  if (model.x != model.y || model.kind == lobe64::kAshikhminShirley) return errorsOf(mirroredSquares(model, widest, polar, azimuths), terms);
  const auto value = [&](const Vec3& wo, const Vec3& wi) { return lobe64::modelTimesCosine(model, wo, wi); };
  return errorsOf(roundSquares(value, lobe64::kHalfPi, widest, polar, azimuths), terms);
}

std::vector<double> factorisationErrors(const RoundReflectance& timesCosine, double widest, int polar, int azimuths, const std::vector<int>& terms) {
  return errorsOf(roundSquares(timesCosine, widest, widest, polar, azimuths), terms);
}

}  // namespace chiaro
