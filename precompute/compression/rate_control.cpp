#include "precompute/compression/rate_control.h"

#include <algorithm>
#include <cmath>

namespace chiaro {
namespace {

constexpr double kLeastUsed = 0.95, kMostUsed = 1.0;
constexpr double kUsualBytesPerCost = 1.85;  // a first guess
constexpr int kTries = 5;

/// The finest step of which cost * bytesPerCost fits, by halving its logarithm.
double finestStep(const ClusterEncoder& encoder, double bytes, double bytesPerCost, double finest, double coarsest) {
  double low = finest, high = coarsest;
  if (encoder.cost(low) * bytesPerCost <= bytes) return low;
  // Few steps are that coarse: from the fine end outwards.
  while (2.0 * low < high && encoder.cost(2.0 * low) * bytesPerCost > bytes) low *= 2.0;
  high = std::min(high, 2.0 * low);
  for (int i = 0; i < 6; ++i) {
    const double middle = std::sqrt(low * high);
    (encoder.cost(middle) * bytesPerCost <= bytes ? high : low) = middle;
  }
  return high;
}

}  // namespace

CodedLists encodeWithin(const ClusterEncoder& encoder, const RateTarget& target, std::size_t vertices, int threads,
                        Transfer& transfer) {
  const double all = target.bytesPerVertex * static_cast<double>(vertices);
  if (std::isinf(target.bytesPerVertex)) {
    encoder.encode(target.finest, transfer);
    return codedLists(transfer, threads);
  }

  // What does not shrink with the step is told apart by its size, and the rest by what coding makes of the last steps.
  const double coarsest = std::max(std::sqrt(12.0 * target.mostRounding / encoder.numbersPerVertex()), target.finest);
  double step = finestStep(encoder, all, kUsualBytesPerCost, target.finest, coarsest), lastStep = step, lastCoded = 0.0;
  CodedLists lists;
  for (int i = 0; i < kTries; ++i) {
    encoder.encode(step, transfer);
    lists = codedLists(transfer, threads);
    const double used = transfer.bytesPerVertex(vertices, &lists) * static_cast<double>(vertices),
                 coded = static_cast<double>(lists.bytes());
    if (used <= kMostUsed * all && (used >= kLeastUsed * all || step <= target.finest)) break;
    const double fixed = used - coded;
    double wanted = finestStep(encoder, all - fixed, coded / std::max(encoder.cost(step), 1.0), target.finest, coarsest);
    // Limits of bits make finer steps cost less than they seem to: then by the last two.
    const double slope = std::log(coded / lastCoded) / std::log(step / lastStep);
    if (i > 0 && slope < -0.05 && all > fixed)
      wanted = std::clamp(step * std::pow((all - fixed) / coded, 1.0 / slope), target.finest, coarsest);
    if (wanted == step) break;
    lastStep = step;
    lastCoded = coded;
    step = wanted;
  }
  return lists;
}

}  // namespace chiaro
