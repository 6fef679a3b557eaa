#pragma once
/// Dense matrix products by the BLAS, which brings kernels for the processor it finds itself on; Eigen's own are compiled for the oldest one.
/// One thread each (parallelBlocks spreads them), the same bits for the same shapes on the same kind of processor.

#include <Eigen/Core>

namespace chiaro {

template <typename Scalar>
using RowMajor = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// Any row-major block; rows may lie further apart than they are long.
template <typename Scalar>
using RowMajorRef = Eigen::Ref<const RowMajor<Scalar>, 0, Eigen::OuterStride<>>;

/// a b
RowMajor<float> product(const RowMajorRef<float>& a, const RowMajorRef<float>& b);
RowMajor<double> product(const RowMajorRef<double>& a, const RowMajorRef<double>& b);
/// a^T b
RowMajor<float> productTransposedA(const RowMajorRef<float>& a, const RowMajorRef<float>& b);
RowMajor<double> productTransposedA(const RowMajorRef<double>& a, const RowMajorRef<double>& b);
/// a b^T
RowMajor<float> productTransposedB(const RowMajorRef<float>& a, const RowMajorRef<float>& b);

/// a^T a
RowMajor<float> gram(const RowMajorRef<float>& a);
/// Of a symmetric matrix with no eigenvalue at or below 0. Throws std::domain_error for another.
Eigen::MatrixXd inverseOfPositive(Eigen::MatrixXd matrix);

/// Orthonormal columns that span what `block`'s do (Cholesky QR, twice: Yamamoto, Nakatsukasa, Yanagisawa and Fukaya 2015). Columns
/// that depend on those before them, to within the precision of float, come back as zero.
RowMajor<float> orthonormalised(const RowMajor<float>& block);

}  // namespace chiaro
