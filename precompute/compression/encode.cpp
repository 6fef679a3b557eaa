#include "precompute/compression/encode.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace chiaro {

void encodePca(const Pca& pca, const Scene& scene, Transfer& transfer) {
  const auto terms = static_cast<std::size_t>(pca.terms);
  transfer.terms = pca.terms;
  transfer.mean = pca.mean;
  transfer.eigenfunctions = pca.functions;
  for (float& value : transfer.eigenfunctions) value = static_cast<float>(Eigen::half(value));

  const std::size_t vertexCount = scene.vertexCount();
  transfer.weightScale.assign(terms, 0.0f);
  for (std::size_t i = 0; i < vertexCount; ++i)
    for (std::size_t k = 0; k < terms; ++k)
      transfer.weightScale[k] = std::max(transfer.weightScale[k], std::abs(pca.weights[i * terms + k]));

  transfer.primitives.resize(scene.primitives.size());
  const auto stride = static_cast<std::size_t>(transfer.paddedTerms());
  std::size_t row = 0;
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const auto count = scene.primitives[p].positions.size();
    auto& weights = transfer.primitives[p].weights;
    weights.assign(count * stride, 0);
    for (std::size_t i = 0; i < count; ++i, ++row)
      for (std::size_t k = 0; k < terms; ++k)
        weights[i * stride + k] = static_cast<std::int16_t>(std::lrint(pca.weights[row * terms + k] / transfer.weightScale[k] * 32767.0f));
  }
}

const std::int16_t* weightsOf(const Transfer& transfer, std::size_t index) {
  const auto stride = static_cast<std::size_t>(transfer.paddedTerms());
  if (stride == 0) return nullptr;
  for (const auto& primitive : transfer.primitives) {
    const auto count = primitive.weights.size() / stride;
    if (index < count) return primitive.weights.data() + index * stride;
    index -= count;
  }
  return nullptr;
}

void decodeSsdf(const Transfer& transfer, const std::int16_t* weights, float* ssdf) {
  const auto texels = transfer.mean.size();
  std::copy(transfer.mean.begin(), transfer.mean.end(), ssdf);
  for (std::size_t k = 0; k < static_cast<std::size_t>(transfer.terms); ++k) {
    const float weight = transfer.weightScale[k] * static_cast<float>(weights[k]) / 32767.0f;
    const float* function = transfer.eigenfunctions.data() + k * texels;
    for (std::size_t t = 0; t < texels; ++t) ssdf[t] += weight * function[t];
  }
}

}  // namespace chiaro
