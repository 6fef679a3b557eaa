#pragma once
/// PNG through libpng.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "assets/image/image.h"

namespace chiaro {

bool isPng(std::span<const std::uint8_t> bytes);
glm::ivec2 pngSize(std::span<const std::uint8_t> bytes, const std::string& where);

/// Any PNG as RGBA of 8 bits; colour space chunks are ignored, as glTF 2.0 (3.9.2) asks. Throws Error (unreadableInput) unless
/// the file is whole and its critical chunks have the right sums.
Image8 decodePng(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace chiaro
