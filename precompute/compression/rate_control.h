#pragma once
/// The step that makes a transfer as large as it may be.

#include "assets/transfer/coded_lists.h"
#include "precompute/compression/encode_clusters.h"

namespace chiaro {

struct RateTarget {
  double bytesPerVertex = 0.0;  ///< all counted; infinite: `finest`
  double finest = 5e-4;         ///< step
  double mostRounding = 1e3;    ///< mean squared error of a row that rounding may add about, whatever the bytes
};

/// Encodes with the finest step that fits, as far as it can be told: from nineteen twentieths of the bytes to all of them, unless a limit of the
/// step or what does not depend on it stands against that.
CodedLists encodeWithin(const ClusterEncoder& encoder, const RateTarget& target, std::size_t vertices, int threads,
                        Transfer& transfer);

}  // namespace chiaro
