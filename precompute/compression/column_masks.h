#pragma once
/// Which values of a row matter.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace chiaro {

/// Every row has one of a few masks: 1 where its value matters, 0 where any will do.
struct ColumnMasks {
  std::vector<std::vector<float>> masks;  ///< #columns each, in [0, 1]; one with nothing but 1 may be empty
  std::vector<std::uint16_t> ofRow;       ///< index into `masks`

  const std::vector<float>& of(std::size_t row) const { return masks[ofRow[row]]; }
};

}  // namespace chiaro
