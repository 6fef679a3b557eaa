#pragma once
/// How far one picture is from another, as a screen shows them.

#include <cstddef>

#include "assets/image/display.h"
#include "assets/image/image.h"

namespace chiaro {

/// Which tone map, and how bright.
struct DisplaySettings {
  float exposure = 1.0f;
  ToneMap toneMap = ToneMap::neutral;
};

/// All figures but the counts are of display-encoded channels in [0,1] (displayColor), over the object pixels: those the
/// reference covers by more than half. A pixel that is not finite in either picture is counted, and makes every other figure NaN.
struct PictureDifference {
  std::size_t objectPixels = 0;
  std::size_t undefinedPixels = 0;     ///< object pixels with a NaN or an infinity
  std::size_t coverageMismatches = 0;  ///< pixels that only one of the pictures covers, anywhere
  double rmse = 0.0;                   ///< root of the mean square over pixels and channels
  double psnr = 0.0;                   ///< dB, 20 log10(1 / rmse), at most kHighestPsnr
  double meanAbsolute = 0.0;
  double bias = 0.0;   ///< mean of picture minus reference: positive is too bright
  double worst = 0.0;  ///< largest difference of a channel
  double noise = 0.0;  ///< RMS of the reference's own Monte Carlo noise, from how its halves differ
  /// RMSE against the noiseless truth: the mean product of the differences from the two halves, whose noises are independent,
  /// holds no noise. Never below what two standard errors of that mean can tell.
  double rmseWithoutNoise = 0.0;
};

inline constexpr double kHighestPsnr = 150.0;  ///< equal to float rounding

double psnrOf(double rmse);

/// A reference as two pictures of the same truth with independent noise.
struct ReferenceHalves {
  ImageRgba first, second;
};

/// Their mean: the reference that is shown and compared with.
ImageRgba meanOf(const ReferenceHalves& halves);

/// Against meanOf(reference). Throws Error (failed) when the sizes differ or no pixel is covered.
PictureDifference comparePictures(const ImageRgba& picture, const ReferenceHalves& reference, const DisplaySettings& display);

}  // namespace chiaro
