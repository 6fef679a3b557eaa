#pragma once
/// The figures of a sweep for people and machines.

#include <string>
#include <vector>

#include "precompute/report/sweep/sweep.h"

namespace chiaro {

struct SweepStudy {
  std::string scene;  ///< as the user named it
  bool ground = false;
  SweepScene facts;
  VisibilitySettings measure;
  std::vector<SweepResult> results;
};

/// Figures that a front can be made over. measure: an index into kLobeSharpness, or kWorst: the largest of all.
inline constexpr std::size_t kWorst = kLobeSharpness.size();
enum class SweepPlace { vertices, triangles };
enum class SweepCost { bytesPerVertex, cpuSeconds };
double errorOf(const SweepResult& result, SweepPlace place, std::size_t measure);
double costOf(const SweepResult& result, SweepCost cost);

/// Of all results, whether each is on the front.
std::vector<bool> frontOf(const std::vector<SweepResult>& results, SweepPlace place, std::size_t measure, SweepCost cost);

std::string sweepTable(const SweepStudy& study);
/// Field names: docs/programs.md. Figures that are not defined are null.
std::string sweepJson(const SweepStudy& study, const std::string& version);
/// One line for each point.
std::string sweepCsv(const SweepStudy& study);

}  // namespace chiaro
