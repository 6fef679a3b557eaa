#pragma once
/// JPEG through libjpeg-turbo.

#include <cstdint>
#include <span>
#include <string>

#include "assets/image/image.h"

namespace chiaro {

bool isJpeg(std::span<const std::uint8_t> bytes);
glm::ivec2 jpegSize(std::span<const std::uint8_t> bytes, const std::string& where);

/// Baseline or progressive, grey or YCbCr, as RGBA with alpha 255. Throws Error (unreadableInput); a truncated image is one.
Image8 decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace chiaro
