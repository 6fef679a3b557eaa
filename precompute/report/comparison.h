#pragma once
/// One scene under one light with one material setting, drawn by the runtime and by the reference, or by the runtime from two bakes.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "assets/image/image.h"
#include "assets/transfer/transfer.h"
#include "precompute/bake.h"
#include "precompute/report/metrics.h"
#include "precompute/report/metrics/perceptual.h"
#include "precompute/report/metrics/worst_pixels.h"
#include "precompute/report/report_options.h"

namespace chiaro {

struct Comparison {
  std::string name;                ///< of its files: environment and roughness, fit for a file name, unique in a report
  std::string environment;         ///< as the user gave it
  std::optional<float> roughness;  ///< absent: the scene's own
  std::optional<Reflectance> model;  ///< absent: the scene's own
  DisplaySettings display;
  std::size_t lightCount = 0;  ///< SG lights that the runtime found in the environment
  ImageRgba runtime;           ///< linear radiance, alpha coverage; same pixel centres as `reference`
  ImageRgba reference;
  PictureDifference difference;
  PerceptualDifference perceptual;
  std::vector<WorstPixel> worstPixels;
  std::uint64_t rays = 0;
  double prepareSeconds = 0.0;  ///< environment prefiltering
  double runtimeSeconds = 0.0;  ///< upload and one frame, wall clock, until the pixels are back
  double referenceSeconds = 0.0;
};

struct Comparisons {
  std::vector<Comparison> cases;  ///< environments in the order given, models within, roughnesses within those
  Camera camera;
  std::string glRenderer, glVersion;
};

/// What --fail-over judges: RMSE without the reference's noise. NaN where a pixel is undefined.
double judgedError(const Comparison& one, const ReportOptions& options);

/// Makes a headless OpenGL context and compares every environment with every roughness. other: its pictures, from the same camera and under the same light, are
/// the reference; null: brute force is. Throws Error.
Comparisons compareAll(const BakedScene& baked, const BakedScene* other, const ReportOptions& options, const ProgressHandler& progress);

}  // namespace chiaro
