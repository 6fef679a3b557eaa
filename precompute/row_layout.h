#pragma once
/// What a clustered bake keeps of each vertex.

#include "precompute/bake.h"
#include "precompute/transfer_rows.h"

namespace chiaro {

/// settings: resolved, of a clustered form. directions, directionSharpness: the fixed broad lobes.
TransferRows::Layout rowLayout(const BakeSettings& settings, const std::vector<glm::vec3>& directions, float directionSharpness);

}  // namespace chiaro
