#pragma once
/// From linear radiance to what a screen shows; the formulas live in shaders/lobe/display.glsl.

#include <string>

#include "assets/image/image.h"

namespace chiaro {

/// neutral: Khronos PBR Neutral; aces: Hill's fit of the ACES reference transform; clamp: none, cut at 1.
enum class ToneMap { neutral = 0, aces = 1, clamp = 2 };

/// "neutral", "aces", "clamp". Throws Error (usage).
ToneMap toneMapFromName(const std::string& name);

/// exposure * radiance, tone-mapped, sRGB-encoded, in [0,1]; NaN stays NaN.
glm::vec3 displayColor(glm::vec3 radiance, float exposure, ToneMap toneMap);

/// 8 bit, alpha opaque.
Image8 displayImage(const ImageRgba& radiance, float exposure, ToneMap toneMap);

}  // namespace chiaro
