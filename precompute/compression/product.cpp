#include "precompute/compression/product.h"

#include "precompute/compression/blas_name.h"

#include <cblas.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <mutex>
#include <stdexcept>

// Not in every version's header.
extern "C" {
void openblas_set_num_threads(int);
char* openblas_get_config();
char* openblas_get_corename();
int openblas_get_parallel();  // 0: built for one thread, and then not safe to call from several
void dpotrf_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
void dpotri_(const char* triangle, const int* n, double* matrix, const int* stride, int* info);
}

namespace chiaro {
namespace {

int dimension(Eigen::Index size) { return static_cast<int>(size); }

/// Whether calls may overlap. Blocks run on threads of our own: more inside a call would only get in each other's way.
bool isConcurrent() {
  static const bool concurrent = [] {
    openblas_set_num_threads(1);
    return openblas_get_parallel() != 0;
  }();
  return concurrent;
}

std::unique_lock<std::mutex> callLock() {
  static std::mutex mutex;
  return isConcurrent() ? std::unique_lock<std::mutex>() : std::unique_lock(mutex);
}

void multiply(CBLAS_TRANSPOSE ta, CBLAS_TRANSPOSE tb, const RowMajorRef<float>& a, const RowMajorRef<float>& b, Eigen::Index inner, RowMajor<float>& c) {
  cblas_sgemm(CblasRowMajor, ta, tb, dimension(c.rows()), dimension(c.cols()), dimension(inner), 1.0f, a.data(), dimension(a.outerStride()), b.data(),
              dimension(b.outerStride()), 0.0f, c.data(), dimension(c.outerStride()));
}

void multiply(CBLAS_TRANSPOSE ta, CBLAS_TRANSPOSE tb, const RowMajorRef<double>& a, const RowMajorRef<double>& b, Eigen::Index inner, RowMajor<double>& c) {
  cblas_dgemm(CblasRowMajor, ta, tb, dimension(c.rows()), dimension(c.cols()), dimension(inner), 1.0, a.data(), dimension(a.outerStride()), b.data(),
              dimension(b.outerStride()), 0.0, c.data(), dimension(c.outerStride()));
}

template <typename Scalar>
RowMajor<Scalar> multiplied(CBLAS_TRANSPOSE ta, CBLAS_TRANSPOSE tb, const RowMajorRef<Scalar>& a, const RowMajorRef<Scalar>& b) {
  const bool turnA = ta == CblasTrans, turnB = tb == CblasTrans;
  const auto inner = turnA ? a.rows() : a.cols();
  RowMajor<Scalar> c(turnA ? a.cols() : a.rows(), turnB ? b.rows() : b.cols());
  if (c.size() == 0) return c;
  if (inner == 0) return c.setZero();
  const auto lock = callLock();
  multiply(ta, tb, a, b, inner, c);
  return c;
}

RowMajor<double> orthonormalisedOnce(const RowMajor<double>& block) {
  const Eigen::LDLT<Eigen::MatrixXd> gram(productTransposedA(block, block));
  const Eigen::VectorXd pivots = gram.vectorD();
  const double least = 1e-13 * pivots.maxCoeff();  // float's precision, squared, with room for sums of many rows
  Eigen::VectorXd scale(pivots.size());
  for (Eigen::Index k = 0; k < pivots.size(); ++k) scale[k] = pivots[k] > least ? 1.0 / std::sqrt(pivots[k]) : 0.0;
  // gram = P^T L D L^T P, so block P^T L^-T D^-1/2 is orthonormal.
  Eigen::MatrixXd turn = gram.matrixU().solve(Eigen::MatrixXd(scale.asDiagonal()));
  turn = gram.transpositionsP().transpose() * turn;
  return product(block, RowMajor<double>(turn));
}

}  // namespace

std::string blasName() { return std::string(openblas_get_config()) + ", " + openblas_get_corename(); }

RowMajor<float> product(const RowMajorRef<float>& a, const RowMajorRef<float>& b) { return multiplied<float>(CblasNoTrans, CblasNoTrans, a, b); }
RowMajor<double> product(const RowMajorRef<double>& a, const RowMajorRef<double>& b) { return multiplied<double>(CblasNoTrans, CblasNoTrans, a, b); }
RowMajor<float> productTransposedA(const RowMajorRef<float>& a, const RowMajorRef<float>& b) { return multiplied<float>(CblasTrans, CblasNoTrans, a, b); }
RowMajor<double> productTransposedA(const RowMajorRef<double>& a, const RowMajorRef<double>& b) { return multiplied<double>(CblasTrans, CblasNoTrans, a, b); }
RowMajor<float> productTransposedB(const RowMajorRef<float>& a, const RowMajorRef<float>& b) { return multiplied<float>(CblasNoTrans, CblasTrans, a, b); }

RowMajor<float> gram(const RowMajorRef<float>& a) {
  RowMajor<float> result = RowMajor<float>::Zero(a.cols(), a.cols());
  if (a.size() == 0) return result;
  const auto lock = callLock();
  cblas_ssyrk(CblasRowMajor, CblasLower, CblasTrans, dimension(a.cols()), dimension(a.rows()), 1.0f, a.data(), dimension(a.outerStride()), 0.0f, result.data(),
              dimension(result.outerStride()));
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  return result;
}

Eigen::MatrixXd inverseOfPositive(Eigen::MatrixXd matrix) {
  const int n = dimension(matrix.rows());
  if (n == 0) return matrix;
  int info = 0;
  const auto lock = callLock();
  dpotrf_("L", &n, matrix.data(), &n, &info);
  if (info == 0) dpotri_("L", &n, matrix.data(), &n, &info);
  if (info != 0) throw std::domain_error("inverse: not a positive matrix");
  matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
  return matrix;
}

RowMajor<float> orthonormalised(const RowMajor<float>& block) {
  return orthonormalisedOnce(orthonormalisedOnce(block.cast<double>())).cast<float>();
}

}  // namespace chiaro
