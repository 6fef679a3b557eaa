#pragma once
/// The page of a sweep.

#include <string>

#include "precompute/report/sweep/sweep_tables.h"

namespace chiaro {

std::string sweepPage(const SweepStudy& study, const std::string& version);

}  // namespace chiaro
