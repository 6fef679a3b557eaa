#pragma once
/// The report as one HTML file that needs nothing but itself.

#include <cstdint>
#include <string>
#include <vector>

#include "precompute/report/report_tables.h"

namespace chiaro {

/// PNG files, as on disk.
struct CasePictures {
  std::vector<std::uint8_t> runtime, reference, error;
};

/// `pictures` parallel to comparisons.cases. Pictures are inside as data; no script, no link to anywhere.
std::string reportPage(const ReportFacts& facts, const ReportOptions& options, const Comparisons& comparisons,
                       const std::vector<CasePictures>& pictures);

}  // namespace chiaro
