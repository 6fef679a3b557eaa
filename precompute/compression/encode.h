#pragma once
/// From principal components to what the asset stores.

#include <vector>

#include "assets/transfer/transfer.h"
#include "precompute/compression/pca.h"

namespace chiaro {

/// Fills terms, mean, eigenfunctions, weight scales and the weights of every primitive. `transfer.resolution` is set already; rows of the
/// components are the vertices of `scene` in the order of its primitives. Eigenfunctions are rounded to half, weights to 16 bits of the
/// largest one of their term.
void encodePca(const Pca& pca, const Scene& scene, Transfer& transfer);

/// Row of the PrimitiveTransfer weights of vertex `index` of the whole scene; null where there are no terms.
const std::int16_t* weightsOf(const Transfer& transfer, std::size_t index);

/// The SSDF (resolution^2 values, radians) that the asset holds for a vertex, given its row of PrimitiveTransfer::weights.
void decodeSsdf(const Transfer& transfer, const std::int16_t* weights, float* ssdf);

}  // namespace chiaro
