#include "precompute/report/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/error.h"
#include "precompute/report/metrics/rmse.h"

namespace chiaro {
namespace {

bool covered(const glm::vec4& texel) { return texel.a > 0.5f; }

bool finite(const glm::vec4& texel) {
  return std::isfinite(texel.r) && std::isfinite(texel.g) && std::isfinite(texel.b) && std::isfinite(texel.a);
}

glm::dvec3 displayed(const glm::vec3& radiance, const DisplaySettings& display) {
  return displayColor(radiance, display.exposure, display.toneMap);
}

void requireSameSize(const ImageRgba& a, const ImageRgba& b) {
  if (a.width != b.width || a.height != b.height || a.texels.size() != b.texels.size())
    throw Error(ExitCode::failed, "report", "the pictures to compare differ in size", "this is an error in the program");
}

/// Mean of terms, and how sure it is.
class Mean {
 public:
  void add(double value) {
    sum_ += value;
    squares_ += value * value;
    ++count_;
  }
  double value() const { return sum_ / static_cast<double>(count_); }
  double standardError() const {
    return std::sqrt(std::max(0.0, squares_ / static_cast<double>(count_) - value() * value()) / static_cast<double>(count_));
  }

 private:
  double sum_ = 0.0, squares_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace

double psnrOf(double rmse) {
  if (std::isnan(rmse)) return rmse;
  return rmse <= 0.0 ? kHighestPsnr : std::min(kHighestPsnr, peakSignalToNoise(rmse));
}

ImageRgba meanOf(const ReferenceHalves& halves) {
  requireSameSize(halves.first, halves.second);
  ImageRgba mean = halves.first;
  for (std::size_t i = 0; i < mean.texels.size(); ++i) mean.texels[i] = 0.5f * (halves.first.texels[i] + halves.second.texels[i]);
  return mean;
}

PictureDifference comparePictures(const ImageRgba& picture, const ReferenceHalves& halves, const DisplaySettings& display) {
  const ImageRgba reference = meanOf(halves);
  requireSameSize(picture, reference);
  PictureDifference difference;
  double squares = 0.0, absolutes = 0.0, sum = 0.0, noise = 0.0;
  Mean withoutNoise;
  for (std::size_t i = 0; i < reference.texels.size(); ++i) {
    const glm::vec4 &ours = picture.texels[i], &truth = reference.texels[i];
    difference.coverageMismatches += covered(ours) != covered(truth);
    if (!covered(truth) && std::isfinite(truth.a)) continue;
    ++difference.objectPixels;
    if (!finite(ours) || !finite(truth)) {
      ++difference.undefinedPixels;
      continue;
    }
    const glm::dvec3 shown = displayed(glm::vec3(ours), display);
    const glm::dvec3 error = shown - displayed(glm::vec3(truth), display);
    const glm::dvec3 first = shown - displayed(glm::vec3(halves.first.texels[i]), display);
    const glm::dvec3 second = shown - displayed(glm::vec3(halves.second.texels[i]), display);
    for (int c = 0; c < 3; ++c) {
      squares += error[c] * error[c];
      absolutes += std::abs(error[c]);
      sum += error[c];
      difference.worst = std::max(difference.worst, std::abs(error[c]));
      noise += 0.25 * (first[c] - second[c]) * (first[c] - second[c]);
    }
    withoutNoise.add(glm::dot(first, second) / 3.0);
  }
  if (difference.objectPixels == 0)
    throw Error(ExitCode::failed, "report", "no pixel shows the scene", "give a --camera that looks at it");
  const double count = 3.0 * static_cast<double>(difference.objectPixels);
  difference.rmse = std::sqrt(squares / count);
  difference.psnr = psnrOf(difference.rmse);
  difference.meanAbsolute = absolutes / count;
  difference.bias = sum / count;
  difference.noise = std::sqrt(noise / count);
  difference.rmseWithoutNoise = std::sqrt(std::max(withoutNoise.value(), 2.0 * withoutNoise.standardError()));
  if (difference.undefinedPixels > 0) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    difference.rmse = difference.psnr = difference.meanAbsolute = difference.bias = difference.worst = difference.noise =
        difference.rmseWithoutNoise = nan;
  }
  return difference;
}

}  // namespace chiaro
