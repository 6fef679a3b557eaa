#include "precompute/report/metrics/perceptual.h"

#include "precompute/report/metrics/ssim.h"

namespace chiaro {
namespace {

ImageRgb radianceOf(const ImageRgba& image) {
  ImageRgb rgb{image.width, image.height, {}};
  rgb.texels.reserve(image.texels.size());
  for (const glm::vec4& texel : image.texels) rgb.texels.emplace_back(texel);
  return rgb;
}

/// Not finite stays not finite: tone maps may take an infinity to white.
ImageRgb shown(ImageRgb image, const DisplaySettings& display) {
  for (glm::vec3& texel : image.texels)
    if (isFinite(texel)) texel = displayColor(texel, display.exposure, display.toneMap);
  return image;
}

}  // namespace

PerceptualDifference comparePerceptually(const ImageRgba& picture, const ImageRgba& reference, const DisplaySettings& display,
                                         int threads) {
  const ImageRgb ours = radianceOf(picture), truth = radianceOf(reference);
  requireComparable(truth, ours);
  PixelMask objects;
  for (const glm::vec4& texel : reference.texels) objects.push_back(texel.a > 0.5f);
  const ImageRgb oursShown = shown(ours, display), truthShown = shown(truth, display);
  const FlipSettings settings{.threads = threads};
  PerceptualDifference difference;
  difference.ssim = meanOf(ssim(truthShown, oursShown, threads), objects);
  difference.flipMap = ldrFlip(truthShown, oursShown, settings);
  difference.flip = meanOf(difference.flipMap, objects);
  HdrFlip hdr = hdrFlip(truth, ours, objects, settings);
  difference.range = hdr.range;
  difference.hdrFlipMap = std::move(hdr.map);
  difference.hdrFlip = meanOf(difference.hdrFlipMap, objects);
  return difference;
}

}  // namespace chiaro
