#include "runtime/viewer/preview.h"

#include <algorithm>

namespace chiaro {
namespace {

constexpr int kCoarsest = 8;

}  // namespace

double sampleCount(const RenderSettings& settings) {
  return static_cast<double>(settings.width) * settings.height * settings.supersample * settings.supersample;
}

RenderSettings previewSettings(const RenderSettings& full, double millisecondsPerSample) {
  const auto inTime = [&](const RenderSettings& settings) { return sampleCount(settings) * millisecondsPerSample <= kPreviewMilliseconds; };
  if (inTime(full)) return full;
  RenderSettings coarse = full;
  coarse.supersample = 1;
  for (int fraction = 1; fraction <= kCoarsest; ++fraction) {
    coarse.width = std::max(1, full.width / fraction);
    coarse.height = std::max(1, full.height / fraction);
    if (inTime(coarse)) break;
  }
  return coarse;
}

}  // namespace chiaro
