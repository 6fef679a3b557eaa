#include "assets/transfer/row_decoder.h"

namespace chiaro {

RowDecoder::RowDecoder(const Transfer& transfer) : transfer_(transfer), functions_(transfer.clustered.functions.unpack(transfer.columns())) {
  for (const auto& primitive : transfer.primitives) firstWeight_.push_back(primitive.clustered.firstWeights(transfer.clustered.clusters));
}

void RowDecoder::add(std::size_t vertex, float share, float* row) const {
  std::size_t p = 0;
  while (vertex >= transfer_.primitives[p].clustered.cluster.size()) vertex -= transfer_.primitives[p++].clustered.cluster.size();
  const auto& own = transfer_.primitives[p].clustered;
  const auto& cluster = transfer_.clustered.clusters[own.cluster[vertex]];
  const std::int16_t* weights = own.weights.data() + firstWeight_[p][vertex];

  const auto columns = transfer_.columns(), count = cluster.mean.size();
  std::vector<float> factor(count);
  for (std::size_t d = 0; d < count; ++d) factor[d] = cluster.meanScale * static_cast<float>(cluster.mean[d]) / 32767.0f;
  for (std::size_t k = 0; k < cluster.weightScale.size(); ++k) {
    const float w = cluster.weightScale[k] * static_cast<float>(weights[k]) / 127.0f;
    for (std::size_t d = 0; d < count; ++d) factor[d] += w * static_cast<float>(cluster.components[k * count + d]);
  }
  for (std::size_t j = 0; j < columns; ++j) row[j] += share * transfer_.mean[j];
  for (std::size_t d = 0; d < count; ++d) {
    const float* function = functions_.data() + d * columns;
    const float f = share * factor[d];
    for (std::size_t j = 0; j < columns; ++j) row[j] += f * function[j];
  }
}

}  // namespace chiaro
