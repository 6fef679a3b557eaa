#pragma once
/// The figures of `chiaro-report upsampling` as text and as JSON.

#include <string>
#include <vector>

#include "precompute/report/upsampling/upsampling_options.h"

namespace chiaro {

std::string upsamplingTable(const std::vector<MaterialResult>& results);
std::string upsamplingJson(const std::vector<MaterialResult>& results, const UpsamplingOptions& options, const std::string& glRenderer,
                           const std::string& version);

}  // namespace chiaro
