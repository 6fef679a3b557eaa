#pragma once
/// Radiance .hdr pictures (RGBE). Ward, "Real Pixels", Graphics Gems II, 1991; the file format of Radiance's ray/src/common/color.c.

#include <cstdint>
#include <span>
#include <string>

#include "assets/image/image.h"

namespace chiaro {

/// Flat, old (1,1,1,n) and new (2,2,hi,lo) run-length coded scanlines; EXPOSURE lines are undone. A mantissa m and an exponent e
/// give m 2^(e-136), as in most readers (Radiance itself adds half a step). Throws Error (unreadableInput).
ImageRgb decodeRadianceHdr(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace chiaro
