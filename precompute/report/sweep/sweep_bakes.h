#pragma once
/// The bakes of a sweep, made one after another, or by several processes at once and kept in files until they are measured.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "assets/transfer/transfer.h"
#include "precompute/bake.h"
#include "precompute/report/sweep/sweep_point.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace chiaro {

struct SweepBake {
  BakedScene baked;
  double seconds = 0.0, cpuSeconds = 0.0;
};

/// The point without what only pictures depend on: equal for points that share a bake.
SweepPoint bakeOf(const SweepPoint& point);

class SweepBakes {
 public:
  /// scene: prepared; must outlive it. folder: `baked` in the sweep's, for files of bakes that other processes made under `key`.
  SweepBakes(const Scene& scene, const VisibilitySettings& measure, std::filesystem::path folder, std::string key);

  /// The point's bake: the last one, or read from its file, or made now. Throws Error.
  const SweepBake& get(const SweepPoint& point, const ProgressHandler& progress);
  bool isStored(const SweepPoint& point) const;
  /// Bakes and writes the file. Throws Error.
  void store(const SweepPoint& point, const ProgressHandler& progress) const;
  /// Removes the point's file, if there is one, and the folder where it is empty.
  void forget(const SweepPoint& point) const;
  /// Where what a failed process says goes.
  std::filesystem::path messages(const SweepPoint& point) const { return pathOf(point, ".log"); }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path pathOf(const SweepPoint& point, const char* extension) const;
  SweepBake bakeNow(const SweepPoint& point, const ProgressHandler& progress) const;
  std::optional<SweepBake> read(const SweepPoint& point) const;

  const Scene& scene_;
  VisibilitySettings measure_;
  std::filesystem::path folder_;
  std::string key_;
  std::optional<std::pair<SweepPoint, SweepBake>> last_;
};

/// How many bakes of these points fit beside each other: at most `threads` (0: all cores), and as many as the memory that is free now holds by a rough estimate of
/// each (samples and rows of the largest). At least 1.
int jobsThatFit(const std::vector<SweepPoint>& points, std::size_t vertices, int threads);

/// Stores the bakes of those of `points` that are not stored yet, up to `jobs` at a time, each by a process of this program with `arguments`, then "--bake-point", the
/// point's place in `points`, "--bake-threads" and a share of them. The first that fails ends the others. Throws Error: with the exit code of that process and what it said;
/// interrupted.
void bakeInParallel(const SweepBakes& bakes, const std::vector<SweepPoint>& points, const std::vector<std::size_t>& wanted, int jobs, int threads, const std::vector<std::string>& arguments,
                    const ProgressHandler& progress);

}  // namespace chiaro
