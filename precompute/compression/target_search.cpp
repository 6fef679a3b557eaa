#include "precompute/compression/target_search.h"

#include <algorithm>
#include <cmath>

namespace chiaro {
namespace {

struct Tried {
  double bytes = 0.0, error = 0.0;
};

/// Bytes at which the line through both, in logarithms, has error `wanted`; away from both ends, so that a bent curve is still narrowed down.
double between(const Tried& fails, const Tried& keeps, double wanted) {
  const double fall = std::log(fails.error / keeps.error), share = fall > 0.0 ? std::log(fails.error / wanted) / fall : 0.5;
  return fails.bytes * std::pow(keeps.bytes / fails.bytes, std::clamp(std::isfinite(share) ? share : 0.5, 0.15, 0.85));
}

}  // namespace

FoundBytes fewestBytes(const std::vector<double>& rungs, double target, const std::function<double(double)>& errorOf, double least) {
  std::vector<Tried> tried(rungs.size());
  std::vector<bool> known(rungs.size());
  double last = 0.0;
  const auto ask = [&](double bytes) {
    last = bytes;
    return Tried{bytes, errorOf(bytes)};
  };
  const auto askRung = [&](std::size_t i) {
    if (!known[i]) tried[i] = ask(rungs[i]), known[i] = true;
    return tried[i];
  };
  std::size_t low = 0, high = rungs.size() - 1;
  while (low < high) {
    const auto middle = (low + high) / 2;
    if (askRung(middle).error <= target) high = middle;
    else low = middle + 1;
  }
  Tried keeps = askRung(low);
  if (low > 0 && keeps.error <= target && std::isfinite(keeps.bytes)) {
    Tried fails = tried[low - 1];
    for (int i = 0; i < 3 && !(keeps.error >= least * target); ++i) {
      const Tried one = ask(between(fails, keeps, 0.5 * (1.0 + least) * target));
      (one.error <= target ? keeps : fails) = one;
    }
  }
  return {.bytes = keeps.bytes, .error = keeps.error, .isLast = keeps.bytes == last};
}

}  // namespace chiaro
