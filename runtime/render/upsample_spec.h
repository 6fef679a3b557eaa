#pragma once
/// Upsampling as a person names it on a command line.

#include <string>
#include <vector>

#include "runtime/render/render_settings.h"

namespace chiaro {

/// Names of UpsampleWeights, in its order.
const std::vector<std::string>& upsampleWeightNames();
/// Throws Error (usage).
UpsampleWeights upsampleWeightsFromName(const std::string& name, const std::string& option = "--upsample-weights");

/// "10%" of the pixels (0 to 100), or "2ms" of the GPU's time. Throws Error (usage).
RecomputeBudget parseRecomputeBudget(const std::string& text, const std::string& option = "--recompute-budget");

/// Throws Error (usage) unless 1 to kLargestUpsample. `where` names the setting.
void requireUpsample(int upsample, const std::string& where);

}  // namespace chiaro
