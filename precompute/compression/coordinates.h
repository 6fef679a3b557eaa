#pragma once
/// Every vertex's coordinates in the shared functions, kept small: 16 bits each.

#include <cstdint>
#include <span>
#include <vector>

#include "precompute/compression/clustering.h"
#include "precompute/compression/row_blocks.h"

namespace chiaro {

/// How a row becomes 16-bit numbers.
struct CoordinateScale {
  std::vector<float> most;  ///< the largest value each column can hold; larger ones are clamped

  std::size_t columns() const { return most.size(); }
  void pack(const float* values, std::int16_t* out) const;
  /// The first `count` columns.
  void unpack(const std::int16_t* packed, std::size_t count, float* values) const;
};

/// Some rows are held here, the others may be anywhere.
class CoordinateStore {
 public:
  CoordinateStore() = default;
  /// All rows are held. They may be written from several threads, each row by one.
  CoordinateStore(std::size_t rows, std::vector<float> scale);
  /// Row numbers in `held` (rising) are held; the others are the rows of `rest`, in their order. `rest` must outlive this object.
  CoordinateStore(std::vector<std::uint32_t> held, const RowBlocks& rest, CoordinateScale scale);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return used_; }
  /// From now on only the first `columns` of a row are read.
  void useColumns(std::size_t columns) { used_ = columns; }
  /// row: one that is held.
  void set(std::size_t row, const float* values);
  /// Rows [first, first + count).
  Coordinates read(std::size_t first, std::size_t count) const;
  /// Fastest for rising rows: a block that is not in memory is read once for all that follow one another in it.
  Coordinates read(std::span<const std::uint32_t> rows) const;

 private:
  std::size_t rows_ = 0;
  CoordinateScale scale_;
  std::size_t used_ = 0;
  std::vector<std::uint32_t> held_;
  const RowBlocks* rest_ = nullptr;  ///< null: all rows are held
  std::vector<std::int16_t> values_;
};

}  // namespace chiaro
