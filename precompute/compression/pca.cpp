#include "precompute/compression/pca.h"

#include <Eigen/Core>
#include <algorithm>

#include "precompute/compression/product.h"
#include "precompute/compression/ritz.h"
#include "precompute/compression/weighted_rows.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

using RowMatrix = RowMajor<float>;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

void toFixedPoint(const float* values, std::size_t count, float range, std::int16_t* out) {
  const float scale = 32767.0f / range;
  for (std::size_t j = 0; j < count; ++j) out[j] = roundedToInt16(values[j] * scale);
}

void FixedPointMatrix::setRow(std::size_t i, const float* source) { toFixedPoint(source, columns, range, row(i)); }

Pca leadingTerms(const Pca& pca, int terms) {
  Pca result;
  result.terms = std::min(terms, pca.terms);
  const auto count = static_cast<std::size_t>(result.terms);
  result.mean = pca.mean;
  result.functions.assign(pca.functions.begin(), pca.functions.begin() + index(count * pca.mean.size()));
  result.energy.assign(pca.energy.begin(), pca.energy.begin() + index(count));
  result.totalEnergy = pca.totalEnergy;
  return result;
}

double leastEnergyOf(const PcaSettings& settings, std::size_t rows, const std::vector<float>& columnWeight) {
  double all = 0.0;
  for (const float w : columnWeight) all += static_cast<double>(w);
  return settings.leastRms * settings.leastRms * static_cast<double>(rows) * all;
}

Pca computePca(const FixedPointMatrix& matrix, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress) {
  return computePca(MatrixBlocks(matrix), matrix.range, columnWeight, settings, progress);
}

std::size_t pcaMemory(std::size_t rows, std::size_t columns, const PcaSettings& settings) {
  const auto width = std::min({static_cast<std::size_t>(settings.terms + settings.oversampling), rows, columns});
  const auto strip = std::min(WeightedRows::kStripBytes, 2 * rows * columns) + 2 * RowBlocks::kRows * columns;
  const auto threads = static_cast<std::size_t>(threadCount(settings.threads));
  // The widest moment is orthonormalising: the block, its copy in double, its factors and the result. Rows in use are held as floats too, and a whole
  // strip of them where they are filled in.
  return 3 * strip + strip / columns * width * 2 + threads * RowBlocks::kRows * columns * 4 + columns * width * 36 + rows * width * 4;
}

Pca computePca(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress) {
  const auto columns = rows.columns();
  const WeightedRows a(rows, range, columnWeight, settings.threads);
  Pca result;
  result.mean = a.mean;
  result.totalEnergy = a.energy();

  const double leastEnergy = leastEnergyOf(settings, rows.rows(), columnWeight);
  const auto width = index(std::min({static_cast<std::size_t>(settings.terms + settings.oversampling), rows.rows(), columns}));
  if (!(result.totalEnergy > leastEnergy)) return result;

  const auto iterations = static_cast<std::size_t>(settings.iterations);
  StepCounter steps((2 * iterations + 1) * rows.blocks(), progress);

  RowMatrix basis = gaussianBlock(index(columns), width, settings.seed);
  for (std::size_t k = 0; k < iterations; ++k) basis = orthonormalised(a.covarianceTimes(basis, steps));

  auto& weights = result.weights;  // first the coordinates in the basis
  weights.resize(rows.rows() * static_cast<std::size_t>(width));
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(width, width);
  a.times(basis, steps, [&](std::size_t block, const RowMatrix& coordinates) {
    const RowMajor<double> part = coordinates.cast<double>();
    gram += productTransposedA(part, part);
    std::copy_n(coordinates.data(), coordinates.size(), weights.begin() + index(block * RowBlocks::kRows) * width);
  });
  const auto rotation = ritzStep(basis, gram, a.root, settings.terms, leastEnergy, result);
  // Turned in place, block by block: there are no more terms than there were columns.
  auto to = weights.begin();
  for (std::size_t b = 0; b < rows.blocks(); ++b) {
    const Eigen::Map<const RowMatrix> coordinates(weights.data() + b * RowBlocks::kRows * static_cast<std::size_t>(width), index(rows.rowsOf(b)), width);
    const RowMatrix turned = product(RowMajor<double>(coordinates.cast<double>()), rotation).cast<float>();
    to = std::copy_n(turned.data(), turned.size(), to);
  }
  weights.erase(to, weights.end());
  return result;
}

}  // namespace chiaro
