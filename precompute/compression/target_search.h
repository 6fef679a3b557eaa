#pragma once
/// The fewest bytes that keep an error.

#include <functional>
#include <vector>

namespace chiaro {

struct FoundBytes {
  double bytes = 0.0;
  double error = 0.0;
  bool isLast = false;  ///< whether the last call of errorOf was about these
};

/// Looks for the fewest bytes with errorOf(bytes) <= target: between which of `rungs` (rising; the last may be infinite) it falls below, by halves, and then up to
/// three times in between, as if the logarithm of the error were a line over that of the bytes, until the error is above `least` times the target. Nothing is
/// asked twice. Where no rung keeps the target it is the last; where the first does it is that one. An error that is NaN keeps no target.
FoundBytes fewestBytes(const std::vector<double>& rungs, double target, const std::function<double(double)>& errorOf, double least = 0.93);

}  // namespace chiaro
