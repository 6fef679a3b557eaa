#include "precompute/compression/encode_clusters.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/transfer/block_codec.h"
#include "precompute/compression/allocate_terms.h"
#include "precompute/compression/product.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

constexpr std::size_t kRows = 4096;  // assigned at a time
/// Of a function's energy, what rounding to blocks of 4 bits loses (measured on the built-in scene's functions).
constexpr double kBlockLoss = 0.007;
/// Rounding all functions so may add at most this part of the energy that they leave out.
constexpr double kLossShare = 0.5;

float largest(const std::vector<float>& values) {
  float most = 0.0f;
  for (const float v : values) most = std::max(most, std::abs(v));
  return most;
}

TransferCluster rounded(const Cluster& cluster, int wideTerms) {
  TransferCluster result;
  result.terms = cluster.terms;
  const auto columns = cluster.mean.size();
  result.meanScale = columns == 0 ? 0.0f : std::max(largest(cluster.mean), 1e-30f);
  for (const float m : cluster.mean) result.mean.push_back(static_cast<std::int16_t>(std::lrint(m / result.meanScale * 32767.0f)));
  roundToBlocks(result.mean.data(), columns, 127);
  for (std::size_t k = 0; k < static_cast<std::size_t>(cluster.terms); ++k) {
    const float* row = cluster.components.data() + k * columns;
    float most = 1e-30f;
    for (std::size_t d = 0; d < columns; ++d) most = std::max(most, std::abs(row[d]));
    for (std::size_t d = 0; d < columns; ++d) result.components.push_back(static_cast<std::int8_t>(std::lrint(row[d] / most * 127.0f)));
    if (k >= static_cast<std::size_t>(wideTerms)) roundToBlocks(result.components.data() + k * columns, columns, 7);
  }
  return result;
}

/// Least-squares weights of rows in the rounded components.
class Fit {
 public:
  explicit Fit(const TransferCluster& cluster)
      : mean_(static_cast<Eigen::Index>(cluster.mean.size())), components_(cluster.terms, static_cast<Eigen::Index>(cluster.mean.size())) {
    for (Eigen::Index d = 0; d < mean_.size(); ++d)
      mean_[d] = cluster.meanScale * static_cast<float>(cluster.mean[static_cast<std::size_t>(d)]) / 32767.0f;
    for (Eigen::Index i = 0; i < components_.size(); ++i) components_.data()[i] = static_cast<float>(cluster.components[static_cast<std::size_t>(i)]) / 127.0f;
    // Nearly orthogonal, so well conditioned, but for what rounding made of the weakest.
    gram_.compute(productTransposedB(components_, components_).cast<double>());
  }
  /// rows: #n by #functions.
  RowMajor<float> operator()(const RowMajor<float>& rows) const {
    const Eigen::MatrixXd along = productTransposedB(components_, rows.rowwise() - mean_).cast<double>();
    return gram_.solve(along).transpose().cast<float>();
  }

 private:
  Eigen::RowVectorXf mean_;
  RowMajor<float> components_;
  Eigen::LDLT<Eigen::MatrixXd> gram_;
};

float rounded(float value, float scale, float steps) { return std::clamp(std::nearbyint(value / scale), -steps, steps); }

/// The scale of `steps` to either side that loses least: with few of them, it pays to cut the largest values off.
float bestScale(const std::vector<float>& values, float steps) {
  const float whole = std::max(largest(values) / steps, 1e-30f);
  if (steps > 100.0f) return whole;
  float best = whole;
  double least = std::numeric_limits<double>::infinity();
  for (const float share : {1.0f, 0.85f, 0.72f, 0.61f, 0.52f}) {
    double loss = 0.0;
    for (const float v : values) {
      const double error = static_cast<double>(v - share * whole * rounded(v, share * whole, steps));
      loss += error * error;
    }
    if (loss < least) best = share * whole;
    least = std::min(least, loss);
  }
  return best;
}

/// Bytes left for components and weights when all else is stored.
double bytesForTerms(const Transfer& transfer, const std::vector<Cluster>& clusters, std::size_t vertices, const ClusterEncoding& encoding) {
  const auto& functions = transfer.clustered.functions;
  const double shared = static_cast<double>(functions.data.size() + 5 * functions.count() + 4 * transfer.mean.size() + 12 * transfer.directions.size());
  const double fractions = transfer.fractionsInRow() ? 0.0 : static_cast<double>(transfer.directionCount);
  const double ofMeans = static_cast<double>(clusters.size() * (6 + blockBytes8(functions.count())));
  const auto count = static_cast<double>(vertices);
  return std::max(count * (encoding.bytesPerVertex - 2.0 - fractions) - shared - ofMeans, count * encoding.leastTermBytes);
}

void keepWhatFits(std::vector<Cluster>& clusters, const Transfer& transfer, std::size_t vertices, const ClusterEncoding& encoding) {
  double rows = 0.0;
  for (const auto& cluster : clusters) rows += static_cast<double>(cluster.rows);
  const auto functions = transfer.clustered.functions.count();
  const TermBytes cost{.wideTerms = encoding.wideTerms,
                       .component = {static_cast<double>(functions + sizeof(float)), static_cast<double>(blockBytes4(functions) + sizeof(float))},
                       .weight = {encoding.weightBits / 8.0, 0.5},
                       .vertices = static_cast<double>(vertices) / std::max(rows, 1.0)};
  dropWeakTerms(clusters, cost, bytesForTerms(transfer, clusters, vertices, encoding));
}

/// A function whose energy is small against what the functions leave out anyway is rounded coarsely.
void packFunctions(const Pca& pca, int bits, PackedFunctions& packed) {
  const auto columns = pca.mean.size();
  double kept = 0.0;
  for (const double e : pca.energy) kept += e;
  const double discarded = std::max(pca.totalEnergy - kept, 1e-3 * kept);
  for (std::size_t d = 0; d < static_cast<std::size_t>(pca.terms); ++d) {
    const bool coarse = kBlockLoss * pca.energy[d] * pca.terms <= kLossShare * discarded;
    packed.append(pca.functions.data() + d * columns, columns, bits != 0 ? bits : coarse ? 4 : 8);
  }
}

}  // namespace

void encodeClusters(const Pca& pca, std::vector<Cluster> clusters, const CoordinateStore& coordinates,
                    const std::vector<std::size_t>& primitiveVertices, const ClusterEncoding& encoding, Transfer& transfer) {
  auto& out = transfer.clustered;
  const auto rows = coordinates.rows();
  transfer.mean = pca.mean;
  transfer.terms = 0;
  out.weightBits = encoding.weightBits;
  out.wideTerms = encoding.wideTerms;
  packFunctions(pca, encoding.functionBits, out.functions);
  if (encoding.bytesPerVertex > 0.0) keepWhatFits(clusters, transfer, rows, encoding);
  std::vector<Fit> fits;
  for (const auto& cluster : clusters) {
    out.clusters.push_back(rounded(cluster, encoding.wideTerms));
    fits.emplace_back(out.clusters.back());
    transfer.terms = std::max(transfer.terms, cluster.terms);
  }

  const auto most = static_cast<std::size_t>(transfer.terms);
  std::vector<std::uint16_t> owner(rows);
  std::vector<float> weights(rows * most);
  for (std::size_t first = 0; first < rows; first += kRows) {
    const auto count = std::min(kRows, rows - first);
    const auto part = coordinates.read(first, count);
    const auto owners = assignRows(clusters, part, encoding.threads);
    std::copy(owners.begin(), owners.end(), owner.begin() + static_cast<std::ptrdiff_t>(first));
    std::vector<std::vector<std::size_t>> members(clusters.size());
    for (std::size_t i = 0; i < count; ++i) members[owners[i]].push_back(i);
    parallelBlocks(encoding.threads, clusters.size(), [&](std::size_t c) {
      if (clusters[c].terms == 0 || members[c].empty()) return;
      RowMajor<float> own(static_cast<Eigen::Index>(members[c].size()), static_cast<Eigen::Index>(part.columns));
      for (std::size_t i = 0; i < members[c].size(); ++i)
        own.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXf>(part.row(members[c][i]), own.cols());
      const RowMajor<float> fitted = fits[c](own);
      for (std::size_t i = 0; i < members[c].size(); ++i)
        std::copy_n(fitted.row(static_cast<Eigen::Index>(i)).data(), fitted.cols(), weights.data() + (first + members[c][i]) * most);
    });
  }

  const auto steps = [&](std::size_t k) { return k >= static_cast<std::size_t>(encoding.wideTerms) ? 7.0f : encoding.weightBits == 16 ? 32767.0f : 127.0f; };
  std::vector<std::vector<std::size_t>> members(out.clusters.size());
  for (std::size_t i = 0; i < rows; ++i) members[owner[i]].push_back(i);
  parallelBlocks(encoding.threads, out.clusters.size(), [&](std::size_t c) {
    std::vector<float> own(members[c].size());
    for (std::size_t k = 0; k < static_cast<std::size_t>(out.clusters[c].terms); ++k) {
      for (std::size_t i = 0; i < own.size(); ++i) own[i] = weights[members[c][i] * most + k];
      out.clusters[c].weightScale.push_back(bestScale(own, steps(k)));
    }
  });

  transfer.primitives.resize(primitiveVertices.size());
  std::size_t row = 0;
  for (std::size_t p = 0; p < primitiveVertices.size(); ++p) {
    auto& vertices = transfer.primitives[p].clustered;
    for (std::size_t i = 0; i < primitiveVertices[p]; ++i, ++row) {
      vertices.cluster.push_back(owner[row]);
      const auto& scale = out.clusters[owner[row]].weightScale;
      for (std::size_t k = 0; k < scale.size(); ++k)
        vertices.weights.push_back(static_cast<std::int16_t>(rounded(weights[row * most + k], scale[k], steps(k))));
    }
  }
}

}  // namespace chiaro
