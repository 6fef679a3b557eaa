#include "precompute/compression/encode_clusters.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

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

TransferCluster rounded(const Cluster& cluster) {
  TransferCluster result;
  result.terms = cluster.terms;
  const auto columns = cluster.mean.size();
  result.meanScale = columns == 0 ? 0.0f : std::max(largest(cluster.mean), 1e-30f);
  for (const float m : cluster.mean) result.mean.push_back(static_cast<std::int16_t>(std::lrint(m / result.meanScale * 32767.0f)));
  for (std::size_t k = 0; k < static_cast<std::size_t>(cluster.terms); ++k) {
    const float* row = cluster.components.data() + k * columns;
    float most = 1e-30f;
    for (std::size_t d = 0; d < columns; ++d) most = std::max(most, std::abs(row[d]));
    for (std::size_t d = 0; d < columns; ++d) result.components.push_back(static_cast<std::int8_t>(std::lrint(row[d] / most * 127.0f)));
  }
  return result;
}

/// Weights of `row` in the rounded components, as if these were orthogonal, which they are but for the rounding.
void weightsOf(const TransferCluster& cluster, const float* row, float* weights) {
  const auto columns = cluster.mean.size();
  std::vector<float> centred(columns);
  for (std::size_t d = 0; d < columns; ++d) centred[d] = row[d] - cluster.meanScale * static_cast<float>(cluster.mean[d]) / 32767.0f;
  for (std::size_t k = 0; k < static_cast<std::size_t>(cluster.terms); ++k) {
    const std::int8_t* component = cluster.components.data() + k * columns;
    float along = 0.0f, length = 0.0f;
    for (std::size_t d = 0; d < columns; ++d) {
      const float c = static_cast<float>(component[d]) / 127.0f;
      along += c * centred[d];
      length += c * c;
    }
    weights[k] = along / length;
    for (std::size_t d = 0; d < columns; ++d) centred[d] -= weights[k] * static_cast<float>(component[d]) / 127.0f;
  }
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

void encodeClusters(const Pca& pca, const std::vector<Cluster>& clusters, const CoordinateStore& coordinates,
                    const std::vector<std::size_t>& primitiveVertices, const ClusterEncoding& encoding, Transfer& transfer) {
  auto& out = transfer.clustered;
  transfer.mean = pca.mean;
  transfer.terms = 0;
  out.weightBits = encoding.weightBits;
  packFunctions(pca, encoding.functionBits, out.functions);
  for (const auto& cluster : clusters) {
    out.clusters.push_back(rounded(cluster));
    transfer.terms = std::max(transfer.terms, cluster.terms);
  }

  const auto most = static_cast<std::size_t>(transfer.terms);
  const auto rows = coordinates.rows();
  std::vector<std::uint16_t> owner(rows);
  std::vector<float> weights(rows * most);
  for (std::size_t first = 0; first < rows; first += kRows) {
    const auto count = std::min(kRows, rows - first);
    const auto part = coordinates.read(first, count);
    const auto owners = assignRows(clusters, part, encoding.threads);
    std::copy(owners.begin(), owners.end(), owner.begin() + static_cast<std::ptrdiff_t>(first));
    parallelBlocks(encoding.threads, (count + 63) / 64, [&](std::size_t block) {
      for (std::size_t i = block * 64; i < std::min(count, block * 64 + 64); ++i)
        weightsOf(out.clusters[owners[i]], part.row(i), weights.data() + (first + i) * most);
    });
  }

  const float steps = encoding.weightBits == 16 ? 32767.0f : 127.0f;
  for (auto& cluster : out.clusters) cluster.weightScale.assign(static_cast<std::size_t>(cluster.terms), 0.0f);
  for (std::size_t i = 0; i < rows; ++i) {
    auto& scale = out.clusters[owner[i]].weightScale;
    for (std::size_t k = 0; k < scale.size(); ++k) scale[k] = std::max(scale[k], std::abs(weights[i * most + k]) / steps);
  }
  for (auto& cluster : out.clusters)
    for (float& scale : cluster.weightScale) scale = std::max(scale, 1e-30f);

  transfer.primitives.resize(primitiveVertices.size());
  std::size_t row = 0;
  for (std::size_t p = 0; p < primitiveVertices.size(); ++p) {
    auto& vertices = transfer.primitives[p].clustered;
    for (std::size_t i = 0; i < primitiveVertices[p]; ++i, ++row) {
      vertices.cluster.push_back(owner[row]);
      const auto& scale = out.clusters[owner[row]].weightScale;
      for (std::size_t k = 0; k < scale.size(); ++k)
        vertices.weights.push_back(static_cast<std::int16_t>(std::clamp(std::lrint(weights[row * most + k] / scale[k]),
                                                                        -static_cast<long>(steps), static_cast<long>(steps))));
    }
  }
}

}  // namespace chiaro
