#pragma once
/// What `chiaro-report sweep` was asked to do.

#include <filesystem>
#include <string>
#include <vector>

#include "precompute/report/sweep/sweep_point.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace CLI {
class App;
}

namespace chiaro {

struct SweepOptions {
  std::string scene;             ///< a file or builtin: name, not baked
  std::filesystem::path output;  ///< a folder, made where missing
  std::vector<SweepForm> forms{SweepForm::joint, SweepForm::pca};
  std::vector<int> resolutions{32, 64};
  std::vector<int> samplingResolutions{0};
  std::vector<int> terms{0};
  std::vector<double> bytes{16, 36, 72, 104, 224, 480};
  std::vector<int> weightBits{8};
  std::vector<int> functionBits{0};
  bool baselines = true;  ///< the paper's setting, SH and Haar too
  bool ground = false;
  VisibilitySettings measure{.rays = 1024};
  bool quiet = false;
};

/// Declares every option on `app`; `options` must outlive its parse().
void declareSweepOptions(CLI::App& app, SweepOptions& options);

/// Checks what parse() left. Touches no file. Throws Error (usage).
void finishSweepOptions(const SweepOptions& options);

/// Every setting once, in the order of the options; what does not exist together (bytes of pca) is left out.
std::vector<SweepPoint> pointsOf(const SweepOptions& options);

}  // namespace chiaro
