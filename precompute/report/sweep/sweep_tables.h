#pragma once
/// The figures of a sweep for people and machines.

#include <optional>
#include <string>
#include <vector>

#include "precompute/report/sweep/sweep.h"

namespace chiaro {

struct SweepStudy {
  std::string scene;  ///< as the user named it
  bool ground = false;
  SweepScene facts;
  VisibilitySettings measure;
  SweepPictureSettings drawn;
  std::string glRenderer{};  ///< empty: nothing was drawn
  std::optional<double> targetError, targetFrameTime;
  std::vector<SweepResult> results;
  std::optional<std::size_t> chosen{};  ///< choose()

  bool targets() const { return targetError || targetFrameTime; }
};

/// Figures that a front can be made over. measure: an index into kLobeSharpness, kWorst: the largest of all, or kPicture: of the picture, wherever.
inline constexpr std::size_t kWorst = kLobeSharpness.size(), kPicture = kWorst + 1;
enum class SweepPlace { vertices, triangles };
enum class SweepCost { bytesPerVertex, cpuSeconds, frameMilliseconds };
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
