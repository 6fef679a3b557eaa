#include "precompute/compression/clustering.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "precompute/compression/product.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

using RowMatrix = RowMajor<float>;
using Eigen::Index;

constexpr std::size_t kRowBlock = 256;       // part of the result's bits, as every block size here
constexpr int kCandidates = 8;
constexpr int kMeansIterations = 12;
constexpr std::size_t kMeansColumns = 96;    // the strongest columns hold nearly all of the distance
constexpr int kSubspaceIterations = 4;

Index index(std::size_t i) { return static_cast<Index>(i); }

Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>> rowsOf(const Coordinates& c, std::size_t first, std::size_t count, std::size_t columns) {
  return {c.row(first), index(count), index(columns), Eigen::OuterStride<>(index(c.columns))};
}

std::size_t blocksOf(std::size_t rows) { return (rows + kRowBlock - 1) / kRowBlock; }

/// Squared distances of a block of rows to all centres, less the rows' own squared lengths.
RowMatrix distances(const Coordinates& rows, std::size_t first, std::size_t count, const RowMatrix& centers, const Eigen::VectorXf& centerNorm) {
  RowMatrix result = -2.0f * productTransposedB(rowsOf(rows, first, count, static_cast<std::size_t>(centers.cols())), centers);
  result.rowwise() += centerNorm.transpose();
  return result;
}

/// k-means by Lloyd; an empty cluster starts again at the row that is farthest from its centre.
std::vector<std::uint16_t> kMeans(const Coordinates& rows, const ClusterSettings& settings, const std::function<void()>& step) {
  const auto columns = std::min(rows.columns, kMeansColumns);
  const auto count = static_cast<std::size_t>(settings.clusters);
  std::mt19937 random(settings.seed);
  std::vector<std::size_t> order(rows.rows);
  std::iota(order.begin(), order.end(), std::size_t{0});
  RowMatrix centers(index(count), index(columns));
  for (std::size_t c = 0; c < count; ++c) {
    std::swap(order[c], order[c + random() % (rows.rows - c)]);
    centers.row(index(c)) = rowsOf(rows, order[c], 1, columns);
  }
  std::vector<std::uint16_t> owner(rows.rows, 0);
  std::vector<float> far(rows.rows, 0.0f);
  for (int iteration = 0; iteration < kMeansIterations; ++iteration) {
    const Eigen::VectorXf norm = centers.rowwise().squaredNorm();
    parallelBlocks(settings.threads, blocksOf(rows.rows), [&](std::size_t block) {
      const auto first = block * kRowBlock, n = std::min(kRowBlock, rows.rows - first);
      const RowMatrix d = distances(rows, first, n, centers, norm);
      for (std::size_t i = 0; i < n; ++i) {
        Index best = 0;
        far[first + i] = d.row(index(i)).minCoeff(&best) + rowsOf(rows, first + i, 1, columns).squaredNorm();
        owner[first + i] = static_cast<std::uint16_t>(best);
      }
    });
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(index(columns), index(count));
    std::vector<std::size_t> members(count, 0);
    for (std::size_t i = 0; i < rows.rows; ++i) {
      sum.col(owner[i]) += rowsOf(rows, i, 1, columns).row(0).transpose().cast<double>();
      ++members[owner[i]];
    }
    for (std::size_t c = 0; c < count; ++c) {
      if (members[c] > 0) {
        centers.row(index(c)) = (sum.col(index(c)) / static_cast<double>(members[c])).cast<float>().transpose();
        continue;
      }
      const auto farthest = static_cast<std::size_t>(std::max_element(far.begin(), far.end()) - far.begin());
      centers.row(index(c)) = rowsOf(rows, farthest, 1, columns);
      far[farthest] = 0.0f;
    }
    step();
  }
  return owner;
}

/// The `wanted` strongest components of centred rows, by subspace iteration on the smaller of the two Gram matrices' side.
void findComponents(const RowMatrix& centered, int wanted, double leastRms, Cluster& cluster) {
  const auto n = static_cast<std::size_t>(centered.rows());
  // n rows about their mean span at most n - 1 dimensions.
  const auto width = std::min({static_cast<std::size_t>(wanted), n - 1, static_cast<std::size_t>(centered.cols())});
  const double leastEnergy = leastRms * leastRms * static_cast<double>(n);
  if (width == 0 || !(static_cast<double>(centered.squaredNorm()) > leastEnergy)) return;
  const auto wide = index(std::min(width + 4, std::min(n, static_cast<std::size_t>(centered.cols()))));
  // Sums of all rows with random signs: even a direction that only few rows have is in them.
  std::mt19937 random(0);
  RowMatrix weights(centered.rows(), wide);
  for (Index i = 0; i < weights.size(); ++i) weights.data()[i] = (random() & 1u) != 0 ? 1.0f : -1.0f;
  RowMatrix basis = orthonormalised(productTransposedA(centered, weights));
  for (int i = 0; i < kSubspaceIterations; ++i) basis = orthonormalised(productTransposedA(centered, product(centered, basis)));
  weights = product(centered, basis);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(productTransposedA(weights, weights).cast<double>());
  for (std::size_t k = 0; k < width; ++k) {
    const Index from = wide - 1 - index(k);
    if (!(eigen.eigenvalues()[from] > leastEnergy)) break;
    const Eigen::VectorXf component = basis * eigen.eigenvectors().col(from).cast<float>();
    cluster.components.insert(cluster.components.end(), component.data(), component.data() + component.size());
    cluster.energy.push_back(eigen.eigenvalues()[from]);
    ++cluster.terms;
  }
}

std::vector<Cluster> clustersOf(const Coordinates& rows, const std::vector<std::uint16_t>& owner, const ClusterSettings& settings) {
  std::vector<std::vector<std::uint32_t>> members(static_cast<std::size_t>(settings.clusters));
  for (std::size_t i = 0; i < rows.rows; ++i) members[owner[i]].push_back(static_cast<std::uint32_t>(i));
  std::erase_if(members, [](const auto& m) { return m.empty(); });
  std::vector<Cluster> clusters(members.size());
  parallelBlocks(settings.threads, members.size(), [&](std::size_t c) {
    auto& cluster = clusters[c];
    cluster.rows = members[c].size();
    RowMatrix own(index(members[c].size()), index(rows.columns));
    for (std::size_t i = 0; i < members[c].size(); ++i) own.row(index(i)) = rowsOf(rows, members[c][i], 1, rows.columns);
    const Eigen::RowVectorXf mean = own.cast<double>().colwise().mean().cast<float>();
    own.rowwise() -= mean;
    cluster.mean.assign(mean.data(), mean.data() + mean.size());
    findComponents(own, settings.terms, settings.leastRms, cluster);
  });
  return clusters;
}

}  // namespace

std::vector<std::uint16_t> assignRows(const std::vector<Cluster>& clusters, const Coordinates& rows, int threads) {
  const auto count = clusters.size();
  const auto candidates = std::min<std::size_t>(kCandidates, count);
  RowMatrix centers(index(count), index(rows.columns));
  for (std::size_t c = 0; c < count; ++c) centers.row(index(c)) = Eigen::Map<const Eigen::RowVectorXf>(clusters[c].mean.data(), index(rows.columns));
  const Eigen::VectorXf norm = centers.rowwise().squaredNorm();

  // Who may take whom, then cluster by cluster, so that its components are read once.
  std::vector<std::uint16_t> nearest(rows.rows * candidates);
  std::vector<float> apart(rows.rows * candidates);
  parallelBlocks(threads, blocksOf(rows.rows), [&](std::size_t block) {
    const auto first = block * kRowBlock, n = std::min(kRowBlock, rows.rows - first);
    const RowMatrix d = distances(rows, first, n, centers, norm);
    std::vector<std::uint16_t> order(count);
    for (std::size_t i = 0; i < n; ++i) {
      std::iota(order.begin(), order.end(), std::uint16_t{0});
      const auto row = index(i);
      std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(candidates), order.end(), [&](std::uint16_t a, std::uint16_t b) {
        return d(row, a) != d(row, b) ? d(row, a) < d(row, b) : a < b;
      });
      const float own = rowsOf(rows, first + i, 1, rows.columns).squaredNorm();
      for (std::size_t k = 0; k < candidates; ++k) {
        nearest[(first + i) * candidates + k] = order[k];
        apart[(first + i) * candidates + k] = d(row, order[k]) + own;
      }
    }
  });
  std::vector<std::vector<std::uint32_t>> asked(count);  // indices into nearest
  for (std::size_t i = 0; i < nearest.size(); ++i) asked[nearest[i]].push_back(static_cast<std::uint32_t>(i));
  parallelBlocks(threads, count, [&](std::size_t c) {
    const auto& cluster = clusters[c];
    if (cluster.terms == 0) return;
    const Eigen::Map<const RowMatrix> components(cluster.components.data(), cluster.terms, index(rows.columns));
    RowMatrix own, weights;
    for (std::size_t first = 0; first < asked[c].size(); first += kRowBlock) {
      const auto n = std::min(kRowBlock, asked[c].size() - first);
      own.resize(index(n), index(rows.columns));
      for (std::size_t i = 0; i < n; ++i) own.row(index(i)) = rowsOf(rows, asked[c][first + i] / candidates, 1, rows.columns);
      own.rowwise() -= centers.row(index(c));
      weights = productTransposedB(own, components);
      for (std::size_t i = 0; i < n; ++i) apart[asked[c][first + i]] -= weights.row(index(i)).squaredNorm();
    }
  });
  std::vector<std::uint16_t> owner(rows.rows);
  for (std::size_t i = 0; i < rows.rows; ++i) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < candidates; ++k)
      if (apart[i * candidates + k] < apart[i * candidates + best]) best = k;
    owner[i] = nearest[i * candidates + best];
  }
  return owner;
}

std::vector<Cluster> clusterRows(const Coordinates& rows, const ClusterSettings& wanted, const std::function<void(double)>& progress) {
  if (rows.rows == 0) return {};
  ClusterSettings settings = wanted;
  settings.clusters = static_cast<int>(std::clamp<std::size_t>(static_cast<std::size_t>(std::max(wanted.clusters, 1)), 1, rows.rows));
  StepCounter steps(static_cast<std::size_t>(kMeansIterations + 4 * (settings.iterations + 1)), progress);
  auto owner = kMeans(rows, settings, [&] { steps.add(); });
  auto clusters = clustersOf(rows, owner, settings);
  steps.add(4);
  for (int i = 0; i < settings.iterations; ++i) {
    owner = assignRows(clusters, rows, settings.threads);
    clusters = clustersOf(rows, owner, settings);
    steps.add(4);
  }
  return clusters;
}

}  // namespace chiaro
