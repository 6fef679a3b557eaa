#include "runtime/render/upsample_spec.h"

#include <algorithm>
#include <charconv>

#include "assets/error.h"

namespace chiaro {

const std::vector<std::string>& upsampleWeightNames() {
  static const std::vector<std::string> kNames{"lobe", "normal", "bilinear"};
  return kNames;
}

UpsampleWeights upsampleWeightsFromName(const std::string& name, const std::string& option) {
  const auto& names = upsampleWeightNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw usageError(option, "unknown weights \"" + name + "\"", "give one of lobe, normal, bilinear");
  return static_cast<UpsampleWeights>(found - names.begin());
}

RecomputeBudget parseRecomputeBudget(const std::string& text, const std::string& option) {
  float value = 0.0f;
  const char* last = text.data() + text.size();
  const auto [end, status] = std::from_chars(text.data(), last, value);
  const std::string unit(end, last);
  const bool share = unit == "%";
  if (status != std::errc() || !(share || unit == "ms") || !(value >= 0.0f && value <= (share ? 100.0f : 1e4f)))
    throw usageError(option, "\"" + text + "\" is not a budget", "give a share of the pixels such as 10%, or milliseconds such as 2ms");
  if (share) return {.share = value / 100.0f, .milliseconds = 0.0f};
  return {.share = 0.0f, .milliseconds = value};
}

void requireUpsample(int upsample, const std::string& where) {
  if (upsample < 1 || upsample > kLargestUpsample)
    throw usageError(where, "must lie between 1 and " + std::to_string(kLargestUpsample), "give 1 to shade every pixel, 4 for the fastest");
}

}  // namespace chiaro
