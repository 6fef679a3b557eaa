#include "precompute/compression/masked_pca.h"

#include <Eigen/Core>
#include <algorithm>

#include "precompute/compression/product.h"
#include "precompute/compression/ritz.h"
#include "precompute/compression/weighted_rows.h"
#include "precompute/parallel.h"

namespace chiaro {

Pca computeMaskedPca(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, const ColumnMasks& masks,
                     const PcaSettings& settings, const std::function<void(double)>& progress) {
  using Matrix = RowMajor<float>;
  WeightedRows a(rows, range, columnWeight, settings.threads);
  Pca result;
  result.mean = a.mean;
  result.totalEnergy = a.energy();
  const auto count = static_cast<double>(rows.rows());
  const double leastEnergy = leastEnergyOf(settings, rows.rows(), columnWeight);
  if (!(result.totalEnergy > leastEnergy)) return result;

  const auto width = std::min({static_cast<std::size_t>(settings.terms + settings.oversampling), rows.rows(), rows.columns()});
  StepCounter steps((3 + 2 * static_cast<std::size_t>(settings.iterations)) * rows.blocks(), progress);
  Matrix basis = gaussianBlock(static_cast<Eigen::Index>(rows.columns()), static_cast<Eigen::Index>(width), settings.seed);
  basis = orthonormalised(a.covarianceTimes(basis, steps));
  std::vector<Matrix> coordinates(rows.blocks());
  a.times(basis, steps, [&](std::size_t block, const Matrix& part) { coordinates[block] = part; });

  for (int pass = 0; pass < settings.iterations; ++pass) {
    const auto filled = a.filledCovariance(masks, basis, coordinates, steps);
    Eigen::RowVectorXd center = Eigen::RowVectorXd::Zero(basis.cols());
    for (const auto& part : coordinates) center += part.cast<double>().colwise().sum();
    // About the filled rows' own mean: their coordinates sum up to `center`.
    const RowMajor<double> about = filled.covariance - filled.mean.transpose() * center;
    Matrix turned = orthonormalised(about.cast<float>());
    const Eigen::RowVectorXf shift = (filled.mean * basis.cast<double>()).cast<float>();
    const Matrix turn = productTransposedA(basis, turned);
    parallelBlocks(settings.threads, rows.blocks(), [&](std::size_t b) {
      coordinates[b].rowwise() -= shift;
      coordinates[b] = product(coordinates[b], turn);
    });
    basis = std::move(turned);
    for (std::size_t j = 0; j < a.mean.size(); ++j)
      a.mean[j] += static_cast<float>(filled.mean[static_cast<Eigen::Index>(j)] /
                                      static_cast<double>(a.root[static_cast<Eigen::Index>(j)]));
    result.totalEnergy = filled.energy - count * filled.mean.squaredNorm();
  }
  result.mean = a.mean;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(basis.cols(), basis.cols());
  for (const auto& part : coordinates) {
    const RowMajor<double> wide = part.cast<double>();
    gram += productTransposedA(wide, wide);
  }
  ritzStep(basis, gram, a.root, settings.terms, leastEnergy, result);
  return result;
}

}  // namespace chiaro
