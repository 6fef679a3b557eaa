#include "assets/transfer/transfer.h"

namespace chiaro {

std::size_t Transfer::levelTexels() const {
  std::size_t sum = 0;
  for (const auto& level : clustered.levels) sum += static_cast<std::size_t>(level.resolution) * static_cast<std::size_t>(level.resolution);
  return sum;
}

std::size_t Transfer::columns() const {
  return texels() + levelTexels() + (fractionsInRow() ? static_cast<std::size_t>(directionCount) : 0);
}

double Transfer::bytesPerVertex(std::size_t vertexCount) const {
  if (vertexCount == 0) return 0.0;
  const auto size = [](const auto& values) { return static_cast<double>(values.size() * sizeof(values[0])); };
  double bytes = size(mean) + 2.0 * static_cast<double>(eigenfunctions.size()) + size(weightScale) + size(directions);
  if (!fractionsInRow()) bytes += static_cast<double>(directionCount) * static_cast<double>(vertexCount);
  bytes += size(clustered.functions.bits) + size(clustered.functions.scale) + size(clustered.functions.data);
  for (const auto& c : clustered.clusters) bytes += 2.0 + 4.0 + size(c.mean) + size(c.components) + size(c.weightScale);
  bytes += 2.0 * paddedTerms() * static_cast<double>(vertexCount);
  for (const auto& p : primitives)
    bytes += size(p.clustered.cluster) + static_cast<double>(p.clustered.weights.size()) * clustered.weightBits / 8.0;
  return bytes / static_cast<double>(vertexCount);
}

}  // namespace chiaro
