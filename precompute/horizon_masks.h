#pragma once
/// What of a row a renderer may ask for.

#include "precompute/compression/column_masks.h"
#include "precompute/transfer_rows.h"
#include "precompute/visibility/viewpoints.h"

namespace chiaro {

/// Of a one-sided vertex nothing is read far below its horizon: there a lobe's share of what is above is next to nothing. A value matters by the square of
/// that share, of the broadest lobe that reads it, up to one for a lobe on the horizon, and a texel further down for what interpolates there. Vertices
/// with like normals share a mask that serves them all: one for each of `side`^2 cells of an octahedral map, at most.
/// columns: of a row; those behind the maps always matter.
ColumnMasks horizonMasks(const std::vector<Viewpoint>& viewpoints, const TransferRows::Layout& layout, std::size_t columns,
                         int side);

}  // namespace chiaro
