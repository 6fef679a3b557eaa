#include "assets/image/image_limits.h"

#include "assets/error.h"

namespace chiaro {

void requireImageSize(std::int64_t width, std::int64_t height, const std::string& where) {
  if (width < 1 || height < 1 || width > kLargestImageSide || height > kLargestImageSide || width * height > kMostTexels)
    throw inputError(where,
                     "the image is " + std::to_string(width) + "x" + std::to_string(height) + " texels; the limits are 1 to " +
                         std::to_string(kLargestImageSide) + " a side and " + std::to_string(kMostTexels) + " in all",
                     "resize it");
}

}  // namespace chiaro
