#pragma once
/// Rows of 16-bit values that need not be in memory: they are asked for block by block.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace chiaro {

/// To the nearest, within +-32767; in a form that compilers vectorise.
inline std::int16_t roundedToInt16(float value) {
  const float within = std::clamp(value, -32767.0f, 32767.0f);
  return static_cast<std::int16_t>(within + (within < 0.0f ? -0.5f : 0.5f));
}

class RowBlocks {
 public:
  static constexpr std::size_t kRows = 128;  ///< of a block; the last may have fewer. Part of the bits of whatever sums over rows.

  virtual ~RowBlocks() = default;
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t blocks() const { return (rows_ + kRows - 1) / kRows; }
  std::size_t rowsOf(std::size_t block) const { return block + 1 < blocks() ? kRows : rows_ - block * kRows; }

  /// The values of a block, row-major. They lie in `room` unless the rows are in memory, and stay while both do. Thread safe.
  virtual const std::int16_t* block(std::size_t block, std::vector<std::byte>& room) const = 0;

 protected:
  RowBlocks() = default;
  RowBlocks(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns) {}
  RowBlocks(const RowBlocks&) = default;
  RowBlocks(RowBlocks&&) = default;
  RowBlocks& operator=(const RowBlocks&) = default;
  RowBlocks& operator=(RowBlocks&&) = default;

 private:
  std::size_t rows_ = 0, columns_ = 0;
};

}  // namespace chiaro
