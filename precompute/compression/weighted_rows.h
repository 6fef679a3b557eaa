#pragma once
/// A big matrix, centred and with weighted columns, as what passes over it need.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "precompute/compression/column_masks.h"
#include "precompute/compression/product.h"
#include "precompute/compression/row_blocks.h"
#include "precompute/parallel.h"

namespace chiaro {

/// The rows less `mean`, columns multiplied by `root` = sqrt(columnWeight); never built whole. A strip of at most kStripBytes is read at a time, and
/// every sum goes block by block in their order, so neither threads nor strips change a bit.
class WeightedRows {
 public:
  using Matrix = RowMajor<float>;
  static constexpr std::size_t kStripBytes = std::size_t{32} << 20;

  /// The mean is that of the rows as they are.
  WeightedRows(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, int threads);

  std::vector<float> mean;
  Eigen::VectorXf root;

  /// Sum of squares.
  double energy() const;
  /// The matrix times `right` (#columns by l): `use` gets the product of each block of rows, in their order.
  void times(const Matrix& right, StepCounter& steps, const std::function<void(std::size_t block, const Matrix&)>& use) const;
  /// The transposed matrix times the matrix times `right`: #columns by l.
  Matrix covarianceTimes(const Matrix& right, StepCounter& steps) const;

  struct Filled {
    RowMajor<double> covariance;  ///< the filled matrix' transpose times itself times the basis: #columns by l
    Eigen::RowVectorXd mean;      ///< of its rows
    double energy = 0.0;          ///< sum of its squares
  };
  /// Values off the masks are filled in from coordinates * basis^T (for each block #rows of it by l; #columns by l, orthonormal). `coordinates` become
  /// those of the filled rows.
  Filled filledCovariance(const ColumnMasks& masks, const Matrix& basis, std::vector<Matrix>& coordinates,
                          StepCounter& steps) const;

 private:
  using Strip = std::vector<const std::int16_t*>;  ///< blocks of rows, one behind the other

  std::size_t columnBlocks() const;
  void forEachStrip(const std::function<void(std::size_t first, const Strip&)>& use) const;
  void multiply(std::size_t first, const Strip& strip, const Matrix& right, std::vector<Matrix>& products,
                StepCounter& steps) const;
  /// Columns firstColumn, ... of a block's first rows, as many as `part` has.
  void load(const std::int16_t* block, std::size_t firstColumn, Matrix& part) const;
  /// part: a block, loaded. Off the masks it becomes `guess`.
  void fill(std::size_t block, const ColumnMasks& masks, const Matrix& guess, Matrix& part) const;

  const RowBlocks& rows_;
  float step_;
  int threads_;
};

}  // namespace chiaro
