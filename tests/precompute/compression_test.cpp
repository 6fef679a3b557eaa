// Principal components against a dense decomposition, and what the asset keeps of them.
#include "precompute/compression/pca.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "precompute/compression/encode.h"
#include "precompute/compression/target_search.h"

namespace chiaro {
namespace {

constexpr std::size_t kRows = 700, kColumns = 400;  // several blocks of each, none of them whole

std::vector<float> columnWeights(std::size_t columns) {
  std::mt19937 random(3);
  std::vector<float> weights;
  double sum = 0.0;
  for (std::size_t j = 0; j < columns; ++j) sum += static_cast<double>(weights.emplace_back(0.5f + static_cast<float>(random() % 1000) / 500.0f));
  for (float& w : weights) w *= static_cast<float>(4.0 * std::numbers::pi / sum);
  return weights;
}

/// Rows that are a mean plus `rank` directions of falling strength.
FixedPointMatrix lowRank(std::size_t rank, double fall, double noise, std::size_t rows = kRows, std::size_t columns = kColumns) {
  std::mt19937 random(7);
  std::normal_distribution<double> gaussian;
  Eigen::MatrixXd left(rows, rank), right(rank, columns);
  for (auto& x : left.reshaped()) x = gaussian(random);
  for (auto& x : right.reshaped()) x = gaussian(random);
  for (Eigen::Index k = 0; k < right.rows(); ++k) right.row(k) *= 0.1 * std::pow(static_cast<double>(k) + 1.0, -fall) / std::sqrt(static_cast<double>(rank));
  const Eigen::MatrixXd product = left * right;
  FixedPointMatrix matrix(rows, columns, 1.5707963f);
  std::vector<float> row(columns);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j)
      row[j] = static_cast<float>(0.2 + product(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) + noise * gaussian(random));
    matrix.setRow(i, row.data());
  }
  return matrix;
}

Eigen::MatrixXd dense(const FixedPointMatrix& matrix) {
  Eigen::MatrixXd result(matrix.rows, matrix.columns);
  for (std::size_t i = 0; i < matrix.rows; ++i)
    for (std::size_t j = 0; j < matrix.columns; ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = static_cast<double>(matrix.row(i)[j]) * static_cast<double>(matrix.step());
  return result;
}

Eigen::MatrixXd reconstructed(const Pca& pca, std::size_t rows, std::size_t columns) {
  using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto n = static_cast<Eigen::Index>(rows), d = static_cast<Eigen::Index>(columns);
  Eigen::MatrixXd result = Eigen::Map<const Eigen::RowVectorXf>(pca.mean.data(), d).cast<double>().replicate(n, 1);
  if (pca.terms > 0)
    result += Eigen::Map<const RowMatrix>(pca.weights.data(), n, pca.terms).cast<double>() *
              Eigen::Map<const RowMatrix>(pca.functions.data(), pca.terms, d).cast<double>();
  return result;
}

double weightedSquare(const Eigen::MatrixXd& difference, const std::vector<float>& weights) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < difference.cols(); ++j) sum += static_cast<double>(weights[static_cast<std::size_t>(j)]) * difference.col(j).squaredNorm();
  return sum;
}

TEST(PcaTest, FindsTheDenseDecomposition) {
  const auto matrix = lowRank(150, 0.8, 1e-3);
  const auto weights = columnWeights(kColumns);
  const auto pca = computePca(matrix, weights, {.terms = 24});
  ASSERT_EQ(pca.terms, 24);

  Eigen::MatrixXd centred = dense(matrix);
  const Eigen::RowVectorXd mean = centred.colwise().mean();
  for (std::size_t j = 0; j < kColumns; ++j)
    EXPECT_LE(std::abs(static_cast<double>(pca.mean[j]) - mean[static_cast<Eigen::Index>(j)]), 1e-7 + 6e-8 * std::abs(mean[static_cast<Eigen::Index>(j)]));
  centred.rowwise() -= mean;
  for (Eigen::Index j = 0; j < centred.cols(); ++j) centred.col(j) *= std::sqrt(static_cast<double>(weights[static_cast<std::size_t>(j)]));
  const Eigen::VectorXd singular = Eigen::BDCSVD<Eigen::MatrixXd>(centred).singularValues();
  double best = 0.0, found = 0.0;
  for (int k = 0; k < pca.terms; ++k) {
    best += singular[k] * singular[k];
    found += pca.energy[static_cast<std::size_t>(k)];
    // This slow spectrum is what power iterations are for; the weakest terms may still mix with their neighbours.
    EXPECT_LE(std::abs(pca.energy[static_cast<std::size_t>(k)] / (singular[k] * singular[k]) - 1.0), k < 16 ? 2e-3 : 0.1) << k;
  }
  EXPECT_LE(std::abs(pca.totalEnergy / centred.squaredNorm() - 1.0), 1e-5);
  // ALGORITHMS 3.7: with p = 16 and one power iteration the rms is within 1.2 % of the best; we take one more iteration.
  EXPECT_LE(std::sqrt((pca.totalEnergy - found) / (centred.squaredNorm() - best)), 1.01);
}

TEST(PcaTest, FunctionsAreOrthonormalUnderTheWeights) {
  const auto weights = columnWeights(kColumns);
  const auto pca = computePca(lowRank(60, 0.5, 1e-3), weights, {.terms = 32});
  for (int k = 0; k < pca.terms; ++k) {
    for (int l = 0; l <= k; ++l) {
      double product = 0.0;
      for (std::size_t j = 0; j < kColumns; ++j)
        product += static_cast<double>(weights[j]) * static_cast<double>(pca.functions[static_cast<std::size_t>(k) * kColumns + j]) *
                   static_cast<double>(pca.functions[static_cast<std::size_t>(l) * kColumns + j]);
      EXPECT_LE(std::abs(product - (k == l)), 1e-5) << k << " " << l;
    }
    if (k > 0) { EXPECT_LE(pca.energy[static_cast<std::size_t>(k)], pca.energy[static_cast<std::size_t>(k) - 1]); }
  }
}

TEST(PcaTest, TheEnergyLeftOutIsTheErrorMade) {
  const auto matrix = lowRank(150, 0.6, 2e-3);
  const auto weights = columnWeights(kColumns);
  for (const int terms : {1, 8, 40}) {
    const auto pca = computePca(matrix, weights, {.terms = terms});
    double kept = 0.0;
    for (const double e : pca.energy) kept += e;
    const double direct = weightedSquare(reconstructed(pca, kRows, kColumns) - dense(matrix), weights);
    EXPECT_LE(std::abs((pca.totalEnergy - kept) / direct - 1.0), 1e-3) << terms;
  }
}

TEST(PcaTest, KeepsNoMoreTermsThanThereAre) {
  const auto weights = columnWeights(kColumns);
  const auto matrix = lowRank(6, 0.0, 0.0);
  const auto pca = computePca(matrix, weights, {.terms = 48});
  EXPECT_EQ(pca.terms, 6) << "the rounding of fixed point is not a term";
  const Eigen::MatrixXd error = reconstructed(pca, kRows, kColumns) - dense(matrix);
  EXPECT_LE(error.cwiseAbs().maxCoeff(), 1.5 * static_cast<double>(matrix.step())) << "rank terms reproduce the matrix to its rounding";

  FixedPointMatrix same(50, kColumns, 1.5707963f);
  const std::vector<float> row(kColumns, 1.5707963f);
  for (std::size_t i = 0; i < same.rows; ++i) same.setRow(i, row.data());
  const auto nothing = computePca(same, weights, {.terms = 48});
  EXPECT_EQ(nothing.terms, 0);
  EXPECT_TRUE(nothing.weights.empty());
  for (const float m : nothing.mean) EXPECT_LE(std::abs(m - 1.5707963f), 2e-7f);
}

TEST(PcaTest, TakesMatricesSmallerThanItsBlocks) {
  for (const std::size_t rows : {1u, 2u, 5u, 40u}) {
    const auto matrix = lowRank(3, 0.0, 0.01, rows, 16);
    const auto weights = columnWeights(16);
    const auto pca = computePca(matrix, weights, {.terms = 48});
    EXPECT_LE(static_cast<std::size_t>(pca.terms), std::min<std::size_t>(rows, 16));
    const Eigen::MatrixXd error = reconstructed(pca, rows, 16) - dense(matrix);
    EXPECT_LE(error.cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(PcaTest, TheSameBitsForAnyNumberOfThreads) {
  const auto matrix = lowRank(100, 0.5, 1e-3);
  const auto weights = columnWeights(kColumns);
  const auto one = computePca(matrix, weights, {.terms = 20, .threads = 1});
  for (const int threads : {2, 5}) {
    const auto many = computePca(matrix, weights, {.terms = 20, .threads = threads});
    EXPECT_EQ(one.mean, many.mean);
    EXPECT_EQ(one.functions, many.functions);
    EXPECT_EQ(one.weights, many.weights);
    EXPECT_EQ(one.energy, many.energy);
  }
}

TEST(PcaTest, ReportsProgressToTheEnd) {
  double last = 0.0;
  computePca(lowRank(20, 0.5, 1e-3), columnWeights(kColumns), {.terms = 4, .threads = 3}, [&](double done) {
    EXPECT_LT(last, done);
    last = done;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(Encode, RoundingHardlyMatters) {
  constexpr int kResolution = 20;
  const auto matrix = lowRank(80, 0.5, 1e-3);
  const auto weights = columnWeights(kColumns);
  const auto pca = computePca(matrix, weights, {.terms = 30});
  Scene scene;
  scene.primitives.resize(2);
  scene.primitives[0].positions.resize(300);
  scene.primitives[1].positions.resize(kRows - 300);
  Transfer transfer;
  transfer.resolution = kResolution;
  encodePca(pca, scene, transfer);
  ASSERT_EQ(transfer.terms, 30);
  ASSERT_EQ(transfer.paddedTerms(), 32);
  ASSERT_EQ(transfer.primitives[0].weights.size(), 300u * 32u);
  ASSERT_EQ(transfer.primitives[1].weights.size(), (kRows - 300u) * 32u);

  const Eigen::MatrixXd exact = reconstructed(pca, kRows, kColumns);
  Eigen::MatrixXd stored(kRows, kColumns);
  std::vector<float> ssdf(kColumns);
  int largest = 0;
  for (std::size_t i = 0; i < kRows; ++i) {
    const auto* row = i < 300 ? &transfer.primitives[0].weights[i * 32] : &transfer.primitives[1].weights[(i - 300) * 32];
    for (int k = 0; k < 30; ++k) largest = std::max(largest, std::abs(int{row[k]}));
    EXPECT_EQ(row[30], 0);
    EXPECT_EQ(row[31], 0);
    decodeSsdf(transfer, row, ssdf.data());
    for (std::size_t j = 0; j < kColumns; ++j) stored(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = static_cast<double>(ssdf[j]);
  }
  EXPECT_EQ(largest, 32767) << "the scale is the largest weight";
  const double rms = std::sqrt(weightedSquare(stored - exact, weights) / (4.0 * std::numbers::pi * kRows));
  EXPECT_LE(rms, 0.002) << "ALGORITHMS 9.8";
}

TEST(TargetSearch, ComesNearFromBelowOnCurvesOfAnyBend) {
  const std::vector<double> rungs{4, 16, 52, 104, 224, 480, std::numeric_limits<double>::infinity()};
  const std::pair<const char*, std::function<double(double)>> curves[] = {
      {"a power", [](double bytes) { return 0.3 / std::sqrt(bytes); }},
      {"with a floor", [](double bytes) { return 0.01 + 0.5 / bytes; }},
      {"steep, then flat", [](double bytes) { return 0.02 * std::exp(-bytes / 40.0) + 0.2 / std::sqrt(bytes); }}};
  for (const auto& [name, curve] : curves)
    for (const double target : {0.08, 0.05, 0.03, 0.02}) {
      SCOPED_TRACE(name + std::string(" ") + std::to_string(target));
      std::vector<double> asked;
      const auto found = fewestBytes(rungs, target, [&](double bytes) {
        asked.push_back(bytes);
        return curve(bytes);
      });
      EXPECT_LE(found.error, target);
      EXPECT_EQ(found.error, curve(found.bytes));
      if (curve(rungs.front()) > target) {
        EXPECT_GE(found.error, 0.93 * target);
      }
      EXPECT_EQ(found.isLast, found.bytes == asked.back());
      EXPECT_LE(asked.size(), 3u + 1u + 3u);
      std::sort(asked.begin(), asked.end());
      EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end()) << "nothing is asked twice";
    }
}

TEST(TargetSearch, EndsOfTheRungs) {
  const std::vector<double> rungs{4, 16, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(fewestBytes(rungs, 0.5, [](double) { return 0.1; }).bytes, 4.0);
  const auto missed = fewestBytes(rungs, 0.05, [](double) { return 0.1; });
  EXPECT_TRUE(std::isinf(missed.bytes));
  EXPECT_EQ(missed.error, 0.1);
  EXPECT_TRUE(missed.isLast);
  const auto undefined = fewestBytes(rungs, 0.05, [](double) { return std::nan(""); });
  EXPECT_TRUE(std::isinf(undefined.bytes));
  EXPECT_FALSE(undefined.error <= 0.05);
}

}  // namespace
}  // namespace chiaro
