#pragma once
/// What every form of a bake is given.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "precompute/bake.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/journal/journal.h"
#include "precompute/memory_budget.h"
#include "precompute/visibility/viewpoints.h"

namespace chiaro {

/// Kinds of a journal's records.
enum class BakeRecord : std::uint32_t {
  pcaRows = 1,          ///< pca form: blocks of SSDFs
  sampledRows = 2,      ///< clustered forms: blocks of whole rows of the sample
  sharedFunctions = 3,  ///< clustered forms: what was made of these
  coordinates = 4,      ///< clustered forms: blocks of the other rows in those functions
};

struct BakeTask {
  const RayScene& rays;
  const std::vector<Viewpoint>& viewpoints;
  const BakeSettings& settings;  ///< resolved
  Journal* journal = nullptr;    ///< null: everything stays in memory
  MemoryBudget memory;
  std::function<std::function<void(double)>(const std::string& name)> stage;
};

}  // namespace chiaro
