#include "assets/transfer/transfer.h"

#include <algorithm>
#include <cmath>

namespace chiaro {

std::size_t Transfer::levelTexels() const {
  std::size_t sum = 0;
  for (const auto& level : clustered.levels) sum += static_cast<std::size_t>(level.resolution) * static_cast<std::size_t>(level.resolution);
  return sum;
}

std::size_t Transfer::columns() const {
  return texels() + levelTexels() + (fractionsInRow() ? static_cast<std::size_t>(directionCount) : 0);
}

double Transfer::bytesPerVertex(std::size_t vertexCount, const CodedLists* coded) const {
  if (vertexCount == 0) return 0.0;
  const auto size = [](const auto& values) { return static_cast<double>(values.size() * sizeof(values[0])); };
  double bytes = size(mean) + 2.0 * static_cast<double>(eigenfunctions.size()) + size(weightScale) + size(directions);
  if (!fractionsInRow()) bytes += static_cast<double>(directionCount) * static_cast<double>(vertexCount);
  bytes += 2.0 * paddedTerms() * static_cast<double>(vertexCount);
  bytes += size(clustered.functions.bits) + size(clustered.functions.scale) + size(clustered.mapScales);
  for (const auto& c : clustered.clusters) bytes += 2.0 + 4.0 + size(c.weightScale);  // terms, mean scale
  if (!clustered.empty()) bytes += static_cast<double>(coded != nullptr ? coded->bytes() : codedLists(*this).bytes());
  return bytes / static_cast<double>(vertexCount);
}

std::vector<float> columnScales(const Transfer& transfer) {
  std::vector<float> scales;
  const auto& c = transfer.clustered;
  if (c.mapScales.empty()) return scales;
  scales.reserve(transfer.columns());
  scales.insert(scales.end(), transfer.texels(), c.mapScales[0]);
  for (std::size_t l = 0; l < c.levels.size(); ++l) {
    const auto side = static_cast<std::size_t>(c.levels[l].resolution);
    scales.insert(scales.end(), side * side, c.mapScales[1 + l]);
  }
  if (transfer.fractionsInRow()) scales.insert(scales.end(), static_cast<std::size_t>(transfer.directionCount), c.mapScales.back());
  return scales;
}

void decodeFractions(Transfer& transfer) {
  if (!transfer.fractionsInRow()) return;
  const auto& c = transfer.clustered;
  const auto columns = transfer.columns(), count = static_cast<std::size_t>(transfer.directionCount);
  const auto maps = clusterMaps(c.clusters, c.functions.unpack(columns), transfer.mean, columns - count, columns);
  std::vector<const float*> first;
  const float* next = maps.data();
  for (const auto& cluster : c.clusters) {
    first.push_back(next);
    next += (1 + static_cast<std::size_t>(cluster.terms)) * count;
  }
  std::vector<float> row(count);
  for (auto& primitive : transfer.primitives) {
    const auto& own = primitive.clustered;
    const auto place = own.firstWeights(c.clusters);
    primitive.visibility.clear();
    for (std::size_t v = 0; v < own.cluster.size(); ++v) {
      const float* map = first[own.cluster[v]];
      const auto& scale = c.clusters[own.cluster[v]].weightScale;
      std::copy_n(map, count, row.data());
      for (std::size_t k = 0; k < scale.size(); ++k) {
        map += count;
        const float w = scale[k] * static_cast<float>(own.weights[place[v] + k]);
        for (std::size_t j = 0; j < count; ++j) row[j] += w * map[j];
      }
      for (const float f : row) primitive.visibility.push_back(static_cast<std::uint8_t>(std::lrint(255.0f * std::clamp(f, 0.0f, 1.0f))));
    }
  }
}

}  // namespace chiaro
