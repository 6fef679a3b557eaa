#pragma once
/// What this room accepts as a picture.

#include <cstdint>
#include <string>

namespace chiaro {

inline constexpr int kLargestImageSide = 32768;
inline constexpr std::int64_t kMostTexels = std::int64_t{1} << 28;  ///< 4 GiB as float RGBA

/// Throws Error (unreadableInput) unless both sides are in 1..kLargestImageSide and the area within kMostTexels.
void requireImageSize(std::int64_t width, std::int64_t height, const std::string& where);

}  // namespace chiaro
