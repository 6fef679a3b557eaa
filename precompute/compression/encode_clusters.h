#pragma once
/// From clusters to what the asset stores.

#include <vector>

#include "assets/transfer/transfer.h"
#include "precompute/compression/clustering.h"
#include "precompute/compression/coordinates.h"
#include "precompute/compression/pca.h"

namespace chiaro {

struct ClusterEncoding {
  int weightBits = 8;     ///< 8 or 16
  int functionBits = 0;   ///< 16, 8 or 4; 0: 8 for those that matter, 4 for the others
  int wideTerms = 1;      ///< of a cluster, with 8 bits a component and weightBits a weight; 4 bits each for the terms behind them
  double bytesPerVertex = 0.0;  ///< all counted, at most: terms that are worth little are dropped. 0: no limit
  double leastTermBytes = 0.0;  ///< a vertex, that the terms may take even so
  int threads = 0;
};

/// Fills terms, mean, the clustered part and every primitive's clusters and weights. resolution, directions and levels are set already;
/// rows of `coordinates` are the vertices of the scene in the order of its primitives, in pca's functions. Weights are those of the
/// *rounded* components.
void encodeClusters(const Pca& pca, std::vector<Cluster> clusters, const CoordinateStore& coordinates,
                    const std::vector<std::size_t>& primitiveVertices, const ClusterEncoding& encoding, Transfer& transfer);

}  // namespace chiaro
