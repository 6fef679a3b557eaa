#include "precompute/report/visibility/visibility_method.h"

#include <algorithm>
#include <cmath>

namespace chiaro {

std::size_t slotOf(const std::vector<std::size_t>& encoded, std::size_t vertex) {
  return static_cast<std::size_t>(std::lower_bound(encoded.begin(), encoded.end(), vertex) - encoded.begin());
}

float rounded16(float value, float scale) {
  return scale > 0.0f ? scale * std::round(value / scale * 32767.0f) / 32767.0f : 0.0f;
}

}  // namespace chiaro
