#pragma once
/// Principal components of rows of which some values do not matter.

#include <functional>
#include <vector>

#include "precompute/compression/column_masks.h"
#include "precompute/compression/pca.h"

namespace chiaro {

/// As computePca(), but only what the masks say has to be reproduced: expectation maximisation (Srebro and Jaakkola, "Weighted Low-Rank
/// Approximations", 2003), each pass of which fills the other values with what the functions so far make of the row and applies the covariance
/// of the filled rows once. settings.iterations: the passes, after one of the rows as they are. The energies are those of the filled rows. Weights are left out: MaskedProjection finds them.
Pca computeMaskedPca(const RowBlocks& rows, float range, const std::vector<float>& columnWeight, const ColumnMasks& masks,
                     const PcaSettings& settings, const std::function<void(double)>& progress = {});

}  // namespace chiaro
