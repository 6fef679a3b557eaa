#pragma once
/// Every vertex's coordinates in the shared functions, kept small: 16 bits each.

#include <cstdint>
#include <vector>

#include "precompute/compression/clustering.h"

namespace chiaro {

/// Rows may be written from several threads, each row by one.
class CoordinateStore {
 public:
  CoordinateStore() = default;
  /// scale: the largest value each column can hold; larger ones are clamped.
  CoordinateStore(std::size_t rows, std::vector<float> scale);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return scale_.size(); }
  void set(std::size_t row, const float* values);
  void get(std::size_t row, float* values) const;
  /// Rows [first, first + count).
  Coordinates read(std::size_t first, std::size_t count) const;
  Coordinates read(const std::vector<std::uint32_t>& rows) const;

 private:
  std::size_t rows_ = 0;
  std::vector<float> scale_;
  std::vector<std::int16_t> values_;
};

}  // namespace chiaro
