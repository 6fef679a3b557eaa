#include "precompute/compression/ritz.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace chiaro {
namespace {

/// A standard normal number that depends on its index alone (splitmix64, Box and Muller).
float gaussian(std::uint64_t seed, std::uint64_t index) {
  const auto mix = [](std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
  };
  const auto unit = [](std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; };
  const auto key = mix(seed) + 2 * index;
  return static_cast<float>(std::sqrt(-2.0 * std::log(unit(mix(key)))) * std::cos(2.0 * std::numbers::pi * unit(mix(key + 1))));
}

}  // namespace

RowMajor<float> gaussianBlock(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed) {
  RowMajor<float> block(rows, columns);
  for (Eigen::Index i = 0; i < block.size(); ++i) block.data()[i] = gaussian(seed, static_cast<std::uint64_t>(i));
  return block;
}

RowMajor<double> ritzStep(const RowMajor<float>& basis, const Eigen::MatrixXd& gram, const Eigen::VectorXf& root, int terms,
                          double leastEnergy, Pca& result) {
  const auto width = static_cast<int>(basis.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const auto strongest = [&](int k) { return width - 1 - k; };  // the solver sorts upwards
  result.terms = 0;
  while (result.terms < std::min(terms, width) && eigen.eigenvalues()[strongest(result.terms)] > leastEnergy) ++result.terms;

  RowMajor<double> rotation(width, result.terms);
  for (int k = 0; k < result.terms; ++k) rotation.col(k) = eigen.eigenvectors().col(strongest(k));
  const RowMajor<double> functions = product(RowMajor<double>(basis.cast<double>()), rotation);
  result.functions.resize(static_cast<std::size_t>(functions.size()));
  auto* to = result.functions.data();
  for (int k = 0; k < result.terms; ++k) {
    // An eigenvector's sign is anyone's choice; ours: its largest entry is positive.
    Eigen::Index largest = 0;
    functions.col(k).cwiseAbs().maxCoeff(&largest);
    const double sign = functions(largest, k) < 0.0 ? -1.0 : 1.0;
    rotation.col(k) *= sign;
    result.energy.push_back(eigen.eigenvalues()[strongest(k)]);
    for (Eigen::Index j = 0; j < functions.rows(); ++j)
      *to++ = static_cast<float>(sign * functions(j, k) / static_cast<double>(root[j]));
  }
  return rotation;
}

}  // namespace chiaro
