#include "precompute/compression/product.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <atomic>
#include <random>

#include "precompute/parallel.h"

namespace chiaro {
namespace {

template <typename Scalar>
RowMajor<Scalar> randomMatrix(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed) {
  std::mt19937 random(seed);
  RowMajor<Scalar> m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = static_cast<Scalar>(random()) * static_cast<Scalar>(0x1p-31) - Scalar(1);
  return m;
}

TEST(Product, IsEigensOwn) {
  const auto a = randomMatrix<float>(37, 91, 1), b = randomMatrix<float>(91, 53, 2);
  const Eigen::MatrixXd truth = a.cast<double>() * b.cast<double>();
  // 91 products of numbers below 1, each rounded to 2^-24.
  EXPECT_TRUE((product(a, b).cast<double>() - truth).cwiseAbs().maxCoeff() < 91 * 6e-8);
  EXPECT_TRUE((productTransposedA(RowMajor<float>(a.transpose()), b).cast<double>() - truth).cwiseAbs().maxCoeff() < 91 * 6e-8);
  EXPECT_TRUE((productTransposedB(a, RowMajor<float>(b.transpose())).cast<double>() - truth).cwiseAbs().maxCoeff() < 91 * 6e-8);
  const RowMajor<double> ad = a.cast<double>(), bd = b.cast<double>();
  EXPECT_TRUE((product(ad, bd) - truth).cwiseAbs().maxCoeff() < 91 * 1.2e-16);
}

TEST(Product, TakesRowsThatLieApartAndEmptyOnes) {
  const auto a = randomMatrix<float>(8, 64, 3), b = randomMatrix<float>(20, 5, 4);
  const RowMajor<float> part = a.leftCols(20);
  EXPECT_EQ(product(a.leftCols(20), b), product(part, b));
  EXPECT_EQ(product(a.leftCols(0), b.topRows(0)), RowMajor<float>::Zero(8, 5));
  EXPECT_EQ(product(a.topRows(0).leftCols(20), b).rows(), 0);
}

// A BLAS built for one thread shares its work space between calls and, now and then, spoils a result.
TEST(Product, CallsFromSeveralThreadsDoNotDisturbOneAnother) {
  const auto a = randomMatrix<float>(256, 900, 7), b = randomMatrix<float>(900, 400, 8);
  const RowMajor<float> alone = product(a, b);
  std::atomic<int> wrong = 0;
  parallelBlocks(5, 400, [&](std::size_t) { wrong += product(a, b) != alone; });
  EXPECT_EQ(wrong, 0);
}

TEST(Orthonormalised, SpansTheSameSpace) {
  RowMajor<float> block = randomMatrix<float>(500, 20, 5);
  for (Eigen::Index k = 0; k < 20; ++k) block.col(k) *= std::pow(0.5f, static_cast<float>(k));  // conditions as power iterations make them
  const auto q = orthonormalised(block);
  EXPECT_TRUE((q.transpose() * q - Eigen::MatrixXf::Identity(20, 20)).cwiseAbs().maxCoeff() < 2e-6f);
  const Eigen::MatrixXf rest = block - q * (q.transpose() * block);
  for (Eigen::Index k = 0; k < 20; ++k) EXPECT_TRUE(rest.col(k).norm() < 1e-5f * block.col(k).norm()) << k;
}

TEST(Orthonormalised, DependentColumnsBecomeZero) {
  RowMajor<float> block = randomMatrix<float>(100, 4, 6);
  block.col(2) = block.col(0) + block.col(1);
  block.col(3).setZero();
  const auto q = orthonormalised(block);
  int kept = 0;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const float length = q.col(k).norm();
    EXPECT_TRUE(length == 0.0f || std::abs(length - 1.0f) < 1e-5f) << length;
    kept += length > 0.5f;
  }
  EXPECT_EQ(kept, 2);
  EXPECT_EQ(orthonormalised(RowMajor<float>::Zero(10, 3)), RowMajor<float>::Zero(10, 3));
}

}  // namespace
}  // namespace chiaro
