#pragma once
/// Principal components of a big matrix whose columns carry weights.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "precompute/compression/row_blocks.h"

namespace chiaro {

/// Rounds `count` values in [-range, range] (others are clamped) to 16-bit fixed point: value = range * q / 32767.
void toFixedPoint(const float* values, std::size_t count, float range, std::int16_t* out);

/// #rows by #columns, row-major, values in [-range, range] held as 16-bit fixed point.
struct FixedPointMatrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  float range = 1.0f;
  std::vector<std::int16_t> values;

  FixedPointMatrix() = default;
  FixedPointMatrix(std::size_t rowCount, std::size_t columnCount, float valueRange)
      : rows(rowCount), columns(columnCount), range(valueRange), values(rowCount * columnCount) {}

  float step() const { return range / 32767.0f; }
  const std::int16_t* row(std::size_t i) const { return values.data() + i * columns; }
  std::int16_t* row(std::size_t i) { return values.data() + i * columns; }
  /// Rounds `source` (#columns) into row i.
  void setRow(std::size_t i, const float* source);
};

/// A matrix in memory, as blocks.
class MatrixBlocks : public RowBlocks {
 public:
  explicit MatrixBlocks(const FixedPointMatrix& matrix) : RowBlocks(matrix.rows, matrix.columns), matrix_(matrix) {}
  const std::int16_t* block(std::size_t block, std::vector<std::byte>&) const override { return matrix_.row(block * kRows); }

 private:
  const FixedPointMatrix& matrix_;
};

struct PcaSettings {
  int terms = 48;
  int oversampling = 16;
  int iterations = 3;            ///< applications of the covariance to the random block: 1 + power iterations
  double leastRms = 5e-5;        ///< terms that change the values by less (weighted rms, the matrix' units) are dropped
  std::uint32_t seed = 0;
  int threads = 0;               ///< never changes the result
};

/// value(i, j) ~ mean[j] + sum_k weights(i, k) functions(k, j), where sum_j columnWeight[j] functions(k, j) functions(l, j) is 1 for
/// k = l and 0 otherwise.
struct Pca {
  int terms = 0;                    ///< at most PcaSettings::terms
  std::vector<float> mean;          ///< #columns
  std::vector<float> functions;     ///< #terms by #columns, row-major; strongest first
  std::vector<float> weights;       ///< #rows by #terms, row-major
  std::vector<double> energy;       ///< #terms: sum over rows of weights^2, falling
  double totalEnergy = 0.0;         ///< sum_ij columnWeight[j] (value - mean)^2
};

/// The strongest `terms` of them, without weights.
Pca leadingTerms(const Pca& pca, int terms);

/// Randomised subspace iteration (Halko, Martinsson and Tropp 2011, algorithm 4.4 on the covariance) and a Rayleigh-Ritz step.
/// Goes over the rows 3 + iterations times, a strip of at most 64 MiB (and at least a block) after the other, so they may be far larger
/// than memory. rows: 16-bit fixed point in [-range, range]. columnWeight: #columns, > 0. progress: share done in [0, 1], one thread at
/// a time.
Pca computePca(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress = {});
Pca computePca(const FixedPointMatrix& matrix, const std::vector<float>& columnWeight, const PcaSettings& settings,
               const std::function<void(double)>& progress = {});

/// Terms with less are dropped (PcaSettings::leastRms).
double leastEnergyOf(const PcaSettings& settings, std::size_t rows, const std::vector<float>& columnWeight);

/// Bytes that computePca() needs at most beside the rows, its result included.
std::size_t pcaMemory(std::size_t rows, std::size_t columns, const PcaSettings& settings);

}  // namespace chiaro
