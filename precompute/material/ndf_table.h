#pragma once
/// A distribution of microfacet normals as numbers: lines of an angle from the normal in degrees and the distribution there.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace chiaro {

struct NdfTable {
  std::vector<double> angle;  ///< radians, ascending, in [0, pi/2], at least three
  std::vector<double> value;  ///< any unit; >= 0, at least one > 0

  /// Linear between entries; constant below the first, 0 beyond the last.
  double at(double radians) const;
  double peak() const;
};

/// CSV with or without a line of names. Throws Error (unreadableInput): fewer than three rows, not two numbers in a row, an angle out of order or
/// of [0, 90], a negative value, all 0.
NdfTable readNdfTable(std::span<const std::uint8_t> csv, const std::string& where);

}  // namespace chiaro
