#pragma once
/// What `chiaro-report sweep` was asked to do.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "precompute/report/sweep/sweep_pictures.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace CLI {
class App;
}

namespace chiaro {

/// The option values as text, before finishSweepOptions() turns them into what is below.
struct SweepOptionTexts {
  std::string size = "320x200";
  std::string camera = "auto";
};

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
  std::vector<int> clusters{0};
  std::vector<int> lobes{0};
  std::vector<int> prefilters{512};
  bool baselines = true;  ///< the paper's setting, SH and Haar too
  bool ground = false;
  SweepPictureSettings pictures;
  bool noFrames = false;           ///< draw nothing: needs no OpenGL
  int jobs = 1;                    ///< bakes at a time; 0: as many as memory holds
  std::optional<double> targetError, targetFrameTime;  ///< what choose() goes by
  int bakePoint = -1;              ///< of a process of bakeInParallel(): this place of pointsOf() alone
  int bakeThreads = 0;             ///< and its threads
  VisibilitySettings measure{.rays = 1024};
  bool quiet = false;
};

/// Declares every option on `app`; the two structures must outlive its parse().
void declareSweepOptions(CLI::App& app, SweepOptions& options, SweepOptionTexts& texts);

/// Checks and converts what parse() left. Writes no file. Throws Error (usage, unreadableInput).
void finishSweepOptions(SweepOptions& options, const SweepOptionTexts& texts);

/// Every setting once, in the order of the options; what does not exist together (bytes of pca) is left out.
std::vector<SweepPoint> pointsOf(const SweepOptions& options);

}  // namespace chiaro
