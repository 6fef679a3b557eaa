#pragma once
/// The page of `chiaro-report visibility`.

#include <string>
#include <vector>

#include "precompute/report/visibility/visibility_tables.h"

namespace chiaro {

std::string visibilityPage(const std::vector<SceneComparison>& scenes, const VisibilitySettings& settings, const std::string& version);

}  // namespace chiaro
