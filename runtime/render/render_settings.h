#pragma once
/// How a Renderer draws a frame.

#include <glm/glm.hpp>
#include <optional>

#include "assets/image/display.h"

namespace chiaro {

/// The last three only with upsampling; else black.
enum class DebugView { none, albedo, normal, roughness, visibility, ssdf, totalWeight, age, recomputed };

/// How alike two samples are: by their lobes (Tokuyoshi 2015), by their normals (Yang et al. 2008, variance .005), or not asked, which is
/// plain bilinear interpolation without the frames before.
enum class UpsampleWeights { lobe, normal, bilinear };

/// The most pixels that are shaded because the filter failed them.
struct RecomputeBudget {
  float share = 0.1f;         ///< of all pixels, 0..1
  float milliseconds = 0.0f;  ///< above 0: instead, as many as the last frame's shading says fit in this GPU time
};

struct RenderSettings {
  int width = 1280;
  int height = 720;
  int supersample = 1;                       ///< n^2 shaded points a pixel, box-filtered before the tone map, 1..8
  glm::mat3 worldFromEnvironment{1.0f};      ///< a rotation, free to change each frame
  float exposure = 1.0f;                     ///< factor on radiance before the tone map
  ToneMap toneMap = ToneMap::neutral;
  bool shadows = true;
  bool energyCompensation = false;           ///< GGX gives back what scatters more than once between its facets
  int lobes = 0;                             ///< 1, 3, 5, 7 or 9 (GGX three times as many): strings of so many for every material; 0: the best known
  bool background = true;                    ///< show the environment behind the scene
  DebugView debugView = DebugView::none;
  int upsample = 1;                          ///< 2, 3 or 4: shade one point of a cell of n^2 and interpolate; blended surfaces are shaded in full
  UpsampleWeights upsampleWeights = UpsampleWeights::lobe;
  std::optional<bool> upsampleEstimate;      ///< filter light as its ratio to an estimate that each pixel has of its own; unset: with lobe weights alone
  RecomputeBudget recompute;
};

inline bool estimatesWhenUpsampled(const RenderSettings& settings) { return settings.upsampleEstimate.value_or(settings.upsampleWeights == UpsampleWeights::lobe); }

/// Of RenderSettings::upsample.
inline constexpr int kLargestUpsample = 4;

}  // namespace chiaro
