// Clustered principal components, on rows whose clusters are known and against components found another way.
#include "precompute/compression/clustering.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "precompute/compression/coordinates.h"

namespace chiaro {
namespace {

/// Of single precision sums over at most 200 columns, relative to the rows' squared length.
constexpr double kRounding = 1e-5;

float normal(std::mt19937& random) { return std::normal_distribution<float>()(random); }

Coordinates filled(std::size_t rows, std::size_t columns, float value = 0.0f) {
  return {.rows = rows, .columns = columns, .values = std::vector<float>(rows * columns, value)};
}

/// `each` rows about each of `clusters` centres, `dimensions` wide: spread 1 in directions of the cluster's own, centres `apart`.
Coordinates planted(std::size_t clusters, std::size_t each, std::size_t columns, std::size_t dimensions, float apart, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  auto rows = filled(clusters * each, columns);
  std::vector<float> center(columns), basis(dimensions * columns);
  const float unit = 1.0f / std::sqrt(static_cast<float>(columns));
  for (std::size_t c = 0; c < clusters; ++c) {
    for (auto& v : center) v = apart * unit * normal(random);
    for (auto& v : basis) v = unit * normal(random);
    for (std::size_t i = 0; i < each; ++i) {
      // Interleaved, so that no run of rows is one cluster.
      float* row = rows.values.data() + (i * clusters + c) * columns;
      std::copy(center.begin(), center.end(), row);
      for (std::size_t k = 0; k < dimensions; ++k) {
        const float w = normal(random);
        for (std::size_t d = 0; d < columns; ++d) row[d] += w * basis[k * columns + d];
      }
    }
  }
  return rows;
}

double squaredError(const Cluster& cluster, const float* row, std::size_t columns) {
  std::vector<double> rest(columns);
  for (std::size_t d = 0; d < columns; ++d) rest[d] = static_cast<double>(row[d]) - static_cast<double>(cluster.mean[d]);
  for (std::size_t k = 0; k < static_cast<std::size_t>(cluster.terms); ++k) {
    const float* component = cluster.components.data() + k * columns;
    double along = 0.0;
    for (std::size_t d = 0; d < columns; ++d) along += rest[d] * static_cast<double>(component[d]);
    for (std::size_t d = 0; d < columns; ++d) rest[d] -= along * static_cast<double>(component[d]);
  }
  double sum = 0.0;
  for (const double r : rest) sum += r * r;
  return sum;
}

double squaredError(const std::vector<Cluster>& clusters, const std::vector<std::uint16_t>& owner, const Coordinates& rows) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.rows; ++i) sum += squaredError(clusters.at(owner[i]), rows.row(i), rows.columns);
  return sum;
}

double errorOf(const Coordinates& rows, const ClusterSettings& settings) {
  const auto clusters = clusterRows(rows, settings);
  return squaredError(clusters, assignRows(clusters, rows, settings.threads), rows);
}

double energyOf(const Coordinates& rows) {
  double sum = 0.0;
  for (const float v : rows.values) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum;
}

/// What the strongest `terms` components of all rows together leave out, by a dense eigenvalue solver.
double globalPcaError(const Coordinates& rows, int terms) {
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows.rows), static_cast<Eigen::Index>(rows.columns));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) m(i, j) = static_cast<double>(rows.row(static_cast<std::size_t>(i))[j]);
  m.rowwise() -= m.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(m.transpose() * m);
  return eigen.eigenvalues().head(m.cols() - terms).sum();
}

void expectOrthonormal(const Cluster& cluster, std::size_t columns) {
  for (int a = 0; a < cluster.terms; ++a)
    for (int b = 0; b <= a; ++b) {
      double dot = 0.0;
      for (std::size_t d = 0; d < columns; ++d)
        dot += static_cast<double>(cluster.components[static_cast<std::size_t>(a) * columns + d]) *
               static_cast<double>(cluster.components[static_cast<std::size_t>(b) * columns + d]);
      EXPECT_LE(std::abs(dot - (a == b ? 1.0 : 0.0)), kRounding);
    }
}

void expectSame(const std::vector<Cluster>& a, const std::vector<Cluster>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t c = 0; c < a.size(); ++c) {
    EXPECT_EQ(a[c].rows, b[c].rows);
    EXPECT_EQ(a[c].terms, b[c].terms);
    EXPECT_EQ(a[c].mean, b[c].mean);
    EXPECT_EQ(a[c].components, b[c].components);
    EXPECT_EQ(a[c].energy, b[c].energy);
  }
}

TEST(Clustering, PlantedClustersAreReproduced) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const auto rows = planted(6, 80, 60, 3, 20.0f, seed);
    // Chance may start two centres in one planted cluster and none in another: three for each leave none without.
    const ClusterSettings settings{.clusters = 18, .terms = 3, .seed = seed, .threads = 1};
    const auto clusters = clusterRows(rows, settings);
    const auto owner = assignRows(clusters, rows, 1);
    EXPECT_LE(squaredError(clusters, owner, rows), kRounding * energyOf(rows)) << seed;
    std::vector<int> plantedIn(clusters.size(), -1);
    for (std::size_t i = 0; i < rows.rows; ++i) {
      auto& own = plantedIn[owner[i]];
      if (own < 0) own = static_cast<int>(i % 6);
      EXPECT_EQ(own, static_cast<int>(i % 6)) << "one cluster holds rows of two planted ones";
    }
    std::size_t all = 0;
    for (const auto& cluster : clusters) {
      all += cluster.rows;
      EXPECT_LE(cluster.terms, 3);
      EXPECT_TRUE(std::is_sorted(cluster.energy.rbegin(), cluster.energy.rend()));
      expectOrthonormal(cluster, rows.columns);
    }
    EXPECT_EQ(all, rows.rows);
  }
}

TEST(Clustering, OneClusterIsPca) {
  const auto rows = planted(5, 60, 40, 6, 3.0f);
  for (const int terms : {1, 4, 12}) {
    const double exact = globalPcaError(rows, terms), found = errorOf(rows, {.clusters = 1, .terms = terms, .iterations = 0, .threads = 1});
    EXPECT_GE(found, exact * (1.0 - 1e-4)) << terms;
    // Five applications of the covariance to four vectors more than wanted leave neighbours of equal strength mixed.
    EXPECT_LE(found, exact * 1.02 + kRounding * energyOf(rows)) << terms;
  }
}

TEST(Clustering, MoreTermsAndClustersAreBetterAndNoneWorseThanGlobalPca) {
  const auto rows = planted(12, 60, 50, 8, 4.0f);
  for (const int terms : {1, 3, 6}) {
    double last = 1.02 * globalPcaError(rows, terms);
    for (const int clusters : {1, 4, 16, 48}) {
      const double error = errorOf(rows, {.clusters = clusters, .terms = terms, .threads = 1});
      EXPECT_LE(error, last) << clusters << " clusters of " << terms << " terms";
      last = error;
    }
  }
  double last = std::numeric_limits<double>::infinity();
  for (const int terms : {0, 1, 2, 4, 8, 16}) {
    const double error = errorOf(rows, {.clusters = 8, .terms = terms, .threads = 1});
    EXPECT_LE(error, last) << terms;
    last = error;
  }
}

TEST(Clustering, RareDirectionsAreFoundToo) {
  // Most rows are equal; the others each have one coordinate of their own, which rows at even distances need not meet.
  auto rows = filled(1000, 200, 1.0f);
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t i = 0; i < 3; ++i) rows.values[(37 + 150 * k + i) * 200 + 90 + 17 * k] += 5.0f + static_cast<float>(i);
  const double exact = globalPcaError(rows, 6);
  EXPECT_LE(exact, 1e-6);
  EXPECT_LE(errorOf(rows, {.clusters = 1, .terms = 6, .threads = 1}), 1e-4 * 18 * 25);
}

TEST(Clustering, RowsGoWhereTheyAreReproducedBest) {
  const auto rows = planted(7, 50, 30, 3, 2.0f);
  // Up to eight clusters, all are candidates.
  for (const int wanted : {1, 2, 5, 8}) {
    const auto clusters = clusterRows(rows, {.clusters = wanted, .terms = 2, .threads = 1});
    const auto owner = assignRows(clusters, rows, 1);
    for (std::size_t i = 0; i < rows.rows; ++i) {
      double best = std::numeric_limits<double>::infinity();
      for (const auto& cluster : clusters) best = std::min(best, squaredError(cluster, rows.row(i), rows.columns));
      double length = 0.0;
      for (std::size_t d = 0; d < rows.columns; ++d) length += static_cast<double>(rows.row(i)[d]) * static_cast<double>(rows.row(i)[d]);
      EXPECT_LE(squaredError(clusters[owner[i]], rows.row(i), rows.columns), best + kRounding * length) << wanted << " clusters, row " << i;
    }
  }
}

TEST(Clustering, AMeanNextToARowLosesToComponentsThatHoldIt) {
  const Cluster line{.rows = 2, .terms = 1, .mean = {10, 0, 0}, .components = {1, 0, 0}, .energy = {1}};
  const Cluster point{.rows = 1, .terms = 0, .mean = {0, 0.5f, 0}, .components = {}, .energy = {}};
  auto rows = filled(2, 3);
  rows.values[4] = 0.4f;
  EXPECT_EQ(assignRows({point, line}, rows, 1), (std::vector<std::uint16_t>{1, 0}));
}

TEST(Clustering, TheSameForAnyNumberOfThreads) {
  const auto rows = planted(9, 120, 110, 5, 3.0f);
  const ClusterSettings one{.clusters = 14, .terms = 4, .seed = 5, .threads = 1};
  const auto clusters = clusterRows(rows, one);
  const auto owner = assignRows(clusters, rows, 1);
  for (const int threads : {2, 3}) {
    auto settings = one;
    settings.threads = threads;
    expectSame(clusterRows(rows, settings), clusters);
    EXPECT_EQ(assignRows(clusters, rows, threads), owner);
  }
}

TEST(Clustering, OneRow) {
  auto rows = filled(1, 5);
  for (std::size_t d = 0; d < 5; ++d) rows.values[d] = static_cast<float>(d) - 2.0f;
  const auto clusters = clusterRows(rows, {.clusters = 64, .terms = 24, .threads = 2});
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].mean, rows.values);
  EXPECT_EQ(clusters[0].terms, 0);
  EXPECT_EQ(assignRows(clusters, rows, 2), std::vector<std::uint16_t>{0});
  EXPECT_TRUE(clusterRows(filled(0, 5), {}).empty());
}

TEST(Clustering, EqualRows) {
  for (const std::size_t count : {std::size_t{2}, std::size_t{300}, std::size_t{10000}}) {
    const auto rows = filled(count, 20, 0.3f);
    const auto clusters = clusterRows(rows, {.clusters = 16, .terms = 8, .threads = 2});
    const auto owner = assignRows(clusters, rows, 2);
    for (const auto& cluster : clusters) EXPECT_EQ(cluster.terms, 0);
    EXPECT_LE(squaredError(clusters, owner, rows), kRounding * energyOf(rows)) << count;
  }
}

TEST(Clustering, ManyDuplicatesAmongOthers) {
  auto rows = filled(10000 + 40, 12, 1.0f);
  std::mt19937 random(4);
  for (std::size_t i = 10000 * 12; i < rows.values.size(); ++i) rows.values[i] = normal(random);
  const auto clusters = clusterRows(rows, {.clusters = 8, .terms = 6, .threads = 2});
  EXPECT_LE(squaredError(clusters, assignRows(clusters, rows, 2), rows), 1.02 * globalPcaError(rows, 6));
}

TEST(Clustering, MoreClustersThanRows) {
  const auto rows = planted(1, 7, 9, 3, 1.0f);
  const auto clusters = clusterRows(rows, {.clusters = 100, .terms = 2, .threads = 1});
  EXPECT_LE(clusters.size(), 7u);
  EXPECT_LE(squaredError(clusters, assignRows(clusters, rows, 1), rows), kRounding * energyOf(rows));
}

TEST(Clustering, NoComponentsAndNoColumns) {
  const auto rows = planted(4, 30, 10, 2, 5.0f);
  for (const auto& cluster : clusterRows(rows, {.clusters = 8, .terms = 0, .threads = 1})) {
    EXPECT_EQ(cluster.terms, 0);
    EXPECT_TRUE(cluster.components.empty());
    for (const float m : cluster.mean) EXPECT_TRUE(std::isfinite(m));
  }
  const auto bare = filled(30, 0);
  const auto clusters = clusterRows(bare, {.clusters = 3, .terms = 2, .threads = 1});
  ASSERT_FALSE(clusters.empty());
  EXPECT_EQ(assignRows(clusters, bare, 1).size(), 30u);
}

TEST(Clustering, ComponentsThatHardlyMatterAreDropped) {
  auto rows = planted(1, 200, 20, 2, 1.0f);
  for (float& v : rows.values) v *= 1e-5f;
  const auto clusters = clusterRows(rows, {.clusters = 1, .terms = 4, .leastRms = 1e-4, .threads = 1});
  EXPECT_EQ(clusters.at(0).terms, 0);
}

TEST(CoordinateStoreTest, ReadsTheFirstColumnsAlone) {
  CoordinateStore store(2, {1.0f, 2.0f, 4.0f});
  const float rows[2][3] = {{1.0f, -2.0f, 4.0f}, {0.0f, 1.0f, -4.0f}};
  for (std::size_t i = 0; i < 2; ++i) store.set(i, rows[i]);
  store.useColumns(2);
  const auto read = store.read(0, 2);
  EXPECT_EQ(read.columns, 2u);
  ASSERT_EQ(read.values.size(), 4u);
  EXPECT_EQ(read.values[1], -2.0f);
  EXPECT_NEAR(read.values[3], 1.0f, 2.0f / 32767);
  store.useColumns(3);
  EXPECT_EQ(store.read(1, 1).values[2], -4.0f);
}

TEST(CoordinateStoreTest, HoldsWhatItIsGivenToHalfAStep) {
  CoordinateStore store(3, {1.0f, 1e-6f, 300.0f});
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const std::vector<float> scale{1.0f, 1e-6f, 300.0f};
  std::vector<float> values;
  for (std::size_t i = 0; i < 9; ++i) values.push_back(scale[i % 3] * uniform(random));
  for (std::size_t i = 0; i < 3; ++i) store.set(i, values.data() + 3 * i);
  const auto all = store.read(0, 3);
  const auto chosen = store.read(std::vector<std::uint32_t>{2, 0});
  for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(std::abs(all.values[i] - values[i]), 0.501f * scale[i % 3] / 32767.0f);
  for (std::size_t d = 0; d < 3; ++d) {
    EXPECT_EQ(chosen.row(0)[d], all.row(2)[d]);
    EXPECT_EQ(chosen.row(1)[d], all.row(0)[d]);
  }
  const float beyond[3]{2.0f, -3e-6f, 299.0f};
  store.set(1, beyond);
  const auto held = store.read(1, 1).values;
  EXPECT_EQ(held[0], 1.0f) << "clamped";
  EXPECT_LE(std::abs(held[1] + 1e-6f), 1e-12f);
}

}  // namespace
}  // namespace chiaro
