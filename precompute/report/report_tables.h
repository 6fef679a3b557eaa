#pragma once
/// The figures of a report for machines.

#include <string>

#include "precompute/report/comparison.h"

namespace chiaro {

struct ReportFacts {
  std::string version;  ///< of chiaro-report
  std::string toneMap;  ///< its name
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  int resolution = 0, terms = 0, directions = 0;
  double bytesPerVertex = 0.0;
};

ReportFacts factsOf(const BakedScene& baked, const ReportOptions& options);

/// NaN when a case has undefined pixels.
double lowestPsnr(const Comparisons& comparisons);
/// Of judgedError().
double highestError(const Comparisons& comparisons, const ReportOptions& options);

/// Figures that are not defined are null. Field names: docs/programs.md.
std::string reportJson(const ReportFacts& facts, const ReportOptions& options, const Comparisons& comparisons);

/// One line a case under one line of names; undefined figures and the scene's own roughness are empty.
std::string reportCsv(const Comparisons& comparisons);

}  // namespace chiaro
