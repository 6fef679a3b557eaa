#pragma once
/// Coordinates of rows in shared functions, by least squares over what matters of each.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "precompute/compression/column_masks.h"
#include "precompute/compression/pca.h"
#include "precompute/compression/product.h"

namespace chiaro {

/// For a row x of mask m the c that makes least  sum_j m_j columnWeight_j (x_j - mean_j - sum_k c_k functions_kj)^2  and, by a hundredth of the weakest
/// function's variance, keeps each c_k as likely as its energy says. Where nothing is masked that is the projection.
class MaskedProjection {
 public:
  /// The masks (not which row has which) are read now. Takes time by #functions^2 #columns for each mask.
  MaskedProjection(const Pca& pca, const std::vector<float>& columnWeight, const ColumnMasks& masks, int threads);

  /// rows: #rows by `stride` floats, of which the first #columns matter; mask: of each. Returns #rows by #functions. Thread safe.
  RowMajor<float> operator()(const float* rows, std::size_t stride, std::span<const std::uint16_t> mask) const;

  /// Bytes it holds.
  static std::size_t memory(std::size_t functions, std::size_t columns, std::size_t masks) {
    return 4 * functions * columns + 4 * masks * (functions * functions + columns);
  }

 private:
  Eigen::RowVectorXf mean_;
  RowMajor<float> weighted_;  ///< #columns by #functions
  std::vector<std::vector<float>> masks_;
  std::vector<RowMajor<float>> inverse_;  ///< of each mask's normal equations; empty where that is the identity
};

}  // namespace chiaro
