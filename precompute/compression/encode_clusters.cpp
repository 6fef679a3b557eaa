#include "precompute/compression/encode_clusters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "precompute/compression/product.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

constexpr std::size_t kRows = 4096;  // of coordinates in memory at once
constexpr double kSmallest = 1e-30;
constexpr std::size_t kStride = 4;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

double largest(const float* values, std::size_t count) {
  float most = 0.0f;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::abs(values[i]));
  return static_cast<double>(most);
}

double standardDeviation(double energy, std::size_t rows) {
  return std::sqrt(energy / static_cast<double>(std::max<std::size_t>(rows, 1)));
}

/// Root mean square of each map's sqrt(columnWeight): SSDF, levels, fractions.
std::vector<float> mapScalesOf(const Transfer& transfer, const std::vector<float>& columnWeight) {
  std::vector<std::size_t> sizes{transfer.texels()};
  for (const auto& level : transfer.clustered.levels)
    sizes.push_back(static_cast<std::size_t>(level.resolution) * static_cast<std::size_t>(level.resolution));
  if (transfer.fractionsInRow()) sizes.push_back(static_cast<std::size_t>(transfer.directionCount));
  std::vector<float> scales;
  std::size_t first = 0;
  double own = 1.0;
  for (const auto size : sizes) {
    double sum = 0.0;
    for (std::size_t j = first; j < first + size; ++j) sum += static_cast<double>(columnWeight[j]);
    const double root = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(size, 1)));
    if (scales.empty()) own = root;
    scales.push_back(static_cast<float>(own / root));
    first += size;
  }
  return scales;
}

/// Least-squares weights of rows in the rounded components.
class Fit {
 public:
  explicit Fit(const TransferCluster& cluster)
      : mean_(index(cluster.mean.size())), components_(cluster.terms, index(cluster.mean.size())) {
    for (Eigen::Index d = 0; d < mean_.size(); ++d)
      mean_[d] = cluster.meanScale * static_cast<float>(cluster.mean[static_cast<std::size_t>(d)]) / 32767.0f;
    for (Eigen::Index i = 0; i < components_.size(); ++i)
      components_.data()[i] = static_cast<float>(cluster.components[static_cast<std::size_t>(i)]) / 127.0f;
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

double steps(double value, double step) { return std::log2(1.0 + std::abs(value) / step); }

}  // namespace

ClusterEncoder::ClusterEncoder(const Pca& pca, const std::vector<Cluster>& clusters, const CoordinateStore& coordinates,
                               const std::vector<std::size_t>& primitiveVertices, const std::vector<float>& columnWeight,
                               const ClusterEncoding& encoding)
    : pca_(pca),
      clusters_(clusters),
      coordinates_(coordinates),
      primitiveVertices_(primitiveVertices),
      columnWeight_(columnWeight),
      encoding_(encoding) {
  double rows = 0.0;
  for (const auto& cluster : clusters) rows += static_cast<double>(cluster.rows);
  verticesPerRow_ = static_cast<double>(coordinates.rows()) / std::max(rows, 1.0);
  double sum = 0.0;
  for (std::size_t j = 0; j < encoding.ssdfTexels; ++j) sum += static_cast<double>(columnWeight[j]);
  ssdfRoot_ = std::sqrt(sum / static_cast<double>(encoding.ssdfTexels));
  for (std::size_t first = 0; first < coordinates.rows(); first += kRows) {
    const auto owners =
        assignRows(clusters, coordinates.read(first, std::min(kRows, coordinates.rows() - first)), encoding.threads);
    owner_.insert(owner_.end(), owners.begin(), owners.end());
  }
}

double ClusterEncoder::functionStep(std::size_t function, double step) const {
  const double deviation = standardDeviation(pca_.energy[function], encoding_.functionRows);
  return step / std::max(std::sqrt(static_cast<double>(coordinates_.rows())) * deviation * ssdfRoot_, kSmallest);
}

int ClusterEncoder::termsKept(const Cluster& cluster, double step) const {
  int kept = 0;
  while (kept < cluster.terms &&
         standardDeviation(cluster.energy[static_cast<std::size_t>(kept)], cluster.rows) > kLeastSteps * step)
    ++kept;
  return kept;
}

TransferCluster ClusterEncoder::rounded(const Cluster& cluster, double step) const {
  TransferCluster result;
  const auto columns = cluster.mean.size();
  const double shared = step / std::sqrt(std::max(vertices(cluster), 1.0));
  const double meanStep = std::max({shared, largest(cluster.mean.data(), columns) / 32767.0, kSmallest});
  result.terms = termsKept(cluster, step);
  result.meanScale = columns == 0 ? 0.0f : static_cast<float>(meanStep * 32767.0);
  for (const float m : cluster.mean)
    result.mean.push_back(static_cast<std::int16_t>(std::clamp(std::lrint(static_cast<double>(m) / meanStep), -32767L, 32767L)));
  for (std::size_t k = 0; k < static_cast<std::size_t>(result.terms); ++k) {
    const float* row = cluster.components.data() + k * columns;
    const double own =
        std::max({shared / standardDeviation(cluster.energy[k], cluster.rows), largest(row, columns) / 127.0, kSmallest});
    for (std::size_t d = 0; d < columns; ++d)
      result.components.push_back(
          static_cast<std::int8_t>(std::clamp(std::lrint(static_cast<double>(row[d]) / own), -127L, 127L)));
  }
  return result;
}

double ClusterEncoder::numbersPerVertex() const {
  double shared = static_cast<double>(pca_.functions.size()), own = 0.0;
  for (const auto& cluster : clusters_) {
    shared += static_cast<double>(cluster.mean.size() + cluster.components.size());
    own += vertices(cluster) * cluster.terms;
  }
  return std::max((shared + own) / static_cast<double>(coordinates_.rows()), 1.0);
}

double ClusterEncoder::cost(double step) const {
  const auto columns = pca_.mean.size();
  std::vector<double> part(static_cast<std::size_t>(pca_.terms) + clusters_.size(), 0.0);
  parallelBlocks(encoding_.threads, part.size(), [&](std::size_t i) {
    double& sum = part[i];
    if (i < static_cast<std::size_t>(pca_.terms)) {
      if (encoding_.functionBits != 0) return;
      const double own = functionStep(i, step);
      for (std::size_t j = 0; j < columns; j += kStride)
        sum += kStride * steps(static_cast<double>(pca_.functions[i * columns + j]), own);
      return;
    }
    const auto& cluster = clusters_[i - static_cast<std::size_t>(pca_.terms)];
    const double shared = step / std::sqrt(std::max(vertices(cluster), 1.0));
    for (std::size_t d = 0; d < cluster.mean.size(); d += kStride)
      sum += kStride * steps(static_cast<double>(cluster.mean[d]), shared);
    for (int k = 0; k < termsKept(cluster, step); ++k) {
      const double deviation = standardDeviation(cluster.energy[static_cast<std::size_t>(k)], cluster.rows);
      const float* row = cluster.components.data() + static_cast<std::size_t>(k) * cluster.mean.size();
      for (std::size_t d = 0; d < cluster.mean.size(); d += kStride)
        sum += kStride * steps(static_cast<double>(row[d]) * deviation, shared);
      sum += vertices(cluster) * (1.0 + steps(deviation, step));
    }
  });
  double sum = 0.0;
  for (const double p : part) sum += p;
  return sum / 8.0;
}

void ClusterEncoder::encode(double step, Transfer& transfer) const {
  auto& out = transfer.clustered;
  const auto rows = coordinates_.rows(), columns = pca_.mean.size();
  transfer.mean = pca_.mean;
  transfer.terms = 0;
  out.weightBits = encoding_.weightBits;
  out.functions = {};
  out.clusters.clear();
  out.mapScales = mapScalesOf(transfer, columnWeight_);
  out.functions.columnScale = columnScales(transfer);
  for (std::size_t d = 0; d < static_cast<std::size_t>(pca_.terms); ++d) {
    const float* values = pca_.functions.data() + d * columns;
    if (encoding_.functionBits != 0) {
      out.functions.append(values, columns, encoding_.functionBits);
      continue;
    }
    double most = 0.0;
    for (std::size_t j = 0; j < columns; ++j)
      most = std::max(most, static_cast<double>(std::abs(values[j]) / out.functions.columnScale[j]));
    out.functions.appendSteps(values, columns, static_cast<float>(std::max({functionStep(d, step) * 2047.0, most, kSmallest})));
  }

  std::vector<std::optional<Fit>> fits(clusters_.size());
  out.clusters.resize(clusters_.size());
  parallelBlocks(encoding_.threads, clusters_.size(), [&](std::size_t c) {
    out.clusters[c] = rounded(clusters_[c], step);
    fits[c].emplace(out.clusters[c]);
  });
  for (const auto& cluster : out.clusters) transfer.terms = std::max(transfer.terms, cluster.terms);

  const auto most = static_cast<std::size_t>(transfer.terms);
  std::vector<float> weights(rows * most);
  for (std::size_t first = 0; first < rows; first += kRows) {
    const auto count = std::min(kRows, rows - first);
    const auto part = coordinates_.read(first, count);
    std::vector<std::vector<std::size_t>> members(clusters_.size());
    for (std::size_t i = 0; i < count; ++i) members[owner_[first + i]].push_back(i);
    parallelBlocks(encoding_.threads, clusters_.size(), [&](std::size_t c) {
      if (out.clusters[c].terms == 0 || members[c].empty()) return;
      RowMajor<float> own(index(members[c].size()), index(part.columns));
      for (std::size_t i = 0; i < members[c].size(); ++i)
        own.row(index(i)) = Eigen::Map<const Eigen::RowVectorXf>(part.row(members[c][i]), own.cols());
      const RowMajor<float> fitted = (*fits[c])(own);
      for (std::size_t i = 0; i < members[c].size(); ++i)
        std::copy_n(fitted.row(index(i)).data(), fitted.cols(), weights.data() + (first + members[c][i]) * most);
    });
  }

  // A step of a weight is one of what it multiplies.
  const double mostSteps = encoding_.weightBits == 16 ? 32767.0 : 127.0;
  std::vector<std::vector<std::size_t>> members(clusters_.size());
  for (std::size_t i = 0; i < rows; ++i) members[owner_[i]].push_back(i);
  parallelBlocks(encoding_.threads, clusters_.size(), [&](std::size_t c) {
    auto& cluster = out.clusters[c];
    for (std::size_t k = 0; k < static_cast<std::size_t>(cluster.terms); ++k) {
      double length = 0.0, widest = 0.0;
      for (std::size_t d = 0; d < cluster.mean.size(); ++d)
        length += std::pow(static_cast<double>(cluster.components[k * cluster.mean.size() + d]) / 127.0, 2);
      for (const auto i : members[c]) widest = std::max(widest, static_cast<double>(std::abs(weights[i * most + k])));
      cluster.weightScale.push_back(
          static_cast<float>(std::max({step / std::max(std::sqrt(length), kSmallest), widest / mostSteps, kSmallest})));
    }
  });

  transfer.primitives.resize(primitiveVertices_.size());
  std::size_t row = 0;
  for (std::size_t p = 0; p < primitiveVertices_.size(); ++p) {
    auto& vertices = transfer.primitives[p].clustered;
    vertices = {};
    for (std::size_t i = 0; i < primitiveVertices_[p]; ++i, ++row) {
      vertices.cluster.push_back(owner_[row]);
      const auto& scale = out.clusters[owner_[row]].weightScale;
      for (std::size_t k = 0; k < scale.size(); ++k)
        vertices.weights.push_back(static_cast<std::int16_t>(
            std::clamp(std::nearbyint(static_cast<double>(weights[row * most + k] / scale[k])), -mostSteps, mostSteps)));
    }
  }
}

}  // namespace chiaro
