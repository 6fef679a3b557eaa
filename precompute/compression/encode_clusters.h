#pragma once
/// From clusters to what the asset stores.

#include <cstdint>
#include <vector>

#include "assets/transfer/transfer.h"
#include "precompute/compression/clustering.h"
#include "precompute/compression/coordinates.h"
#include "precompute/compression/pca.h"

namespace chiaro {

struct ClusterEncoding {
  int weightBits = 8;            ///< 8 or 16: limits how many steps a weight may take
  int functionBits = 0;          ///< 16, 8 or 4; 0: in steps as all else
  std::size_t functionRows = 1;  ///< that pca's energies are sums over
  std::size_t ssdfTexels = 1;    ///< the first columns
  int threads = 0;
};

/// Everything is rounded to steps that follow from one, so that the last bit of each list buys as much (reverse water-filling, Cover and Thomas,
/// "Elements of Information Theory", 10.3.3): a number that n vertices share takes steps 1 / sqrt(n) as large, one that is multiplied by what has the
/// standard deviation d steps 1 / d as large. The entropy coding of the lists (assets/transfer/coded_lists.h) turns small numbers into few bits.
class ClusterEncoder {
 public:
  /// Rows of `coordinates` are the vertices of the scene in the order of its primitives, in pca's functions. columnWeight: #columns. What is passed
  /// must outlive this.
  ClusterEncoder(const Pca& pca, const std::vector<Cluster>& clusters, const CoordinateStore& coordinates,
                 const std::vector<std::size_t>& primitiveVertices, const std::vector<float>& columnWeight,
                 const ClusterEncoding& encoding);

  /// Fills terms, mean, the clustered part but for its levels, and every primitive's clusters and weights; resolution, directions and levels are set
  /// already. step: of a weight, in the units of the rows weighted by columnWeight. Weights are those of the *rounded* components; terms
  /// weaker than kLeastSteps of them are dropped.
  void encode(double step, Transfer& transfer) const;

  /// Nearly proportional to the coded bytes: a logarithm of each number in steps, of every fourth one that many vertices share.
  double cost(double step) const;

  /// Numbers that are rounded, shared ones by as many as share them: each adds step^2 / 12 to the mean squared error of a row, or less.
  double numbersPerVertex() const;

  static constexpr double kLeastSteps = 0.7;

 private:
  TransferCluster rounded(const Cluster& cluster, double step) const;
  int termsKept(const Cluster& cluster, double step) const;
  /// Of the scene.
  double vertices(const Cluster& cluster) const { return static_cast<double>(cluster.rows) * verticesPerRow_; }
  double functionStep(std::size_t function, double step) const;

  const Pca& pca_;
  const std::vector<Cluster>& clusters_;
  const CoordinateStore& coordinates_;
  const std::vector<std::size_t>& primitiveVertices_;
  const std::vector<float>& columnWeight_;
  ClusterEncoding encoding_;
  double verticesPerRow_ = 1.0, ssdfRoot_ = 1.0;  ///< square root of the SSDF's mean columnWeight
  std::vector<std::uint16_t> owner_;              ///< of each vertex
};

}  // namespace chiaro
