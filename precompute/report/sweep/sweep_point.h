#pragma once
/// One setting of a sweep and what it costs and buys.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "precompute/report/visibility/lobe_sharpness.h"

namespace chiaro {

enum class SweepForm { joint, clustered, pca, paper, sphericalHarmonics, haar };

struct SweepPoint {
  SweepForm form = SweepForm::joint;
  int resolution = 64;         ///< stored texels a side
  int samplingResolution = 0;  ///< traced texels a side; 0: as a bake chooses, or not asked
  int terms = 0;               ///< weights; coefficients of SH; wavelets; 0: as a bake chooses
  double bytes = 0.0;          ///< clustered forms: bytes a vertex that were allowed; 0: as a bake chooses
  int weightBits = 0;          ///< clustered forms; else 0
  int functionBits = 0;        ///< clustered forms
  int clusters = 0;            ///< clustered forms; 0: as a bake chooses
  int lobes = 0;               ///< of a drawn bake, RenderSettings::lobes
  int prefilter = 0;           ///< of a drawn bake, SgEnvironmentSettings::finestResolution; 0: not drawn

  bool isBake() const { return form == SweepForm::joint || form == SweepForm::clustered || form == SweepForm::pca; }
  bool operator==(const SweepPoint&) const = default;
};

struct SweepFigures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double bytesPerVertex = 0.0;                  ///< counted
  double seconds = 0.0, cpuSeconds = 0.0;       ///< of the bake; NaN for what is not baked
  ErrorBySharpness atVertices{}, inTriangles{};  ///< mean |error| of the visible fraction
  double frameMilliseconds = kNone;             ///< GPU time of a frame, median; NaN for what is not drawn
  double pictureRmse = kNone;                   ///< display-encoded, from brute force, its noise taken out

  /// The largest over the sharpnesses; NaN where one is.
  static double worst(const ErrorBySharpness& error);
};

struct SweepResult {
  SweepPoint point;
  SweepFigures figures;
};

/// As in the JSON: "joint", "clustered", "pca", "paper", "SH", "Haar".
const char* nameOf(SweepForm form);
/// For people: "joint, 64 x 64, 104 bytes".
std::string labelOf(const SweepPoint& point);

/// One line of JSON without its end, and back; nothing where a line is torn or not of this kind.
std::string resultLine(const std::string& key, const SweepResult& result);
std::optional<SweepResult> parseResultLine(const std::string& line, const std::string& key);

}  // namespace chiaro
