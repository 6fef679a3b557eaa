#pragma once
/// Stored visibility with its stages replaced by exact ones, from the last to the first.

#include <memory>

#include "precompute/report/visibility/visibility_method.h"
#include "precompute/transfer_rows.h"

namespace chiaro {

/// The rows of VisibilityInput::encoded as they were traced, not compressed, interpolated and read as the runtime reads them.
std::unique_ptr<VisibilityMethod> makeRowsMethod(const VisibilityInput& input, const TransferRows::Layout& layout, const std::string& name);

/// At each corner the share of the lobe above its horizon that arrives, traced along the lobe's directions; interpolated, and times the point's own horizon. No
/// map and no half-space in it.
std::unique_ptr<VisibilityMethod> makeTracedCornersMethod(const VisibilityInput& input);

/// Traced at the point itself, along other directions than the truth: what is left is noise.
std::unique_ptr<VisibilityMethod> makeTracedPointMethod(const VisibilityInput& input);

}  // namespace chiaro
