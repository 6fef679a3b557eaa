#pragma once
/// OpenEXR through its own library.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "assets/image/image.h"

namespace chiaro {

struct ExrImage {
  ImageRgba image;                 ///< over the display window; 0 outside the data window
  bool rec709 = true;              ///< false when the header names other primaries or another white
  glm::mat3 rec709FromFile{1.0f};  ///< adapted to D65 (Bradford)
};

/// The first part: scan lines or tiles (full resolution level), any compression, half, float or uint, channels R,G,B[,A] or Y[,A] or
/// Y with subsampled chroma (RY, BY). Throws Error (unreadableInput).
ExrImage decodeExr(std::span<const std::uint8_t> bytes, const std::string& where);

/// Float 32 R,G,B,A, ZIP.
std::vector<std::uint8_t> encodeExr(const ImageRgba& image);

}  // namespace chiaro
