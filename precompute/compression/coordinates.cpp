#include "precompute/compression/coordinates.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace chiaro {

void CoordinateScale::pack(const float* values, std::int16_t* out) const {
  for (std::size_t d = 0; d < columns(); ++d) out[d] = roundedToInt16(values[d] / most[d] * 32767.0f);
}

void CoordinateScale::unpack(const std::int16_t* packed, std::size_t count, float* values) const {
  for (std::size_t d = 0; d < count; ++d) values[d] = static_cast<float>(packed[d]) * (most[d] / 32767.0f);
}

CoordinateStore::CoordinateStore(std::size_t rows, std::vector<float> scale)
    : rows_(rows), scale_{std::move(scale)}, used_(scale_.columns()), values_(rows * scale_.columns()) {}

CoordinateStore::CoordinateStore(std::vector<std::uint32_t> held, const RowBlocks& rest, CoordinateScale scale)
    : rows_(held.size() + rest.rows()), scale_(std::move(scale)), used_(scale_.columns()), held_(std::move(held)), rest_(&rest), values_(held_.size() * scale_.columns()) {
  if (rest.columns() != scale_.columns()) throw std::invalid_argument("CoordinateStore: rows of another length");
}

void CoordinateStore::set(std::size_t row, const float* values) {
  const auto place = rest_ == nullptr ? row : static_cast<std::size_t>(std::lower_bound(held_.begin(), held_.end(), row) - held_.begin());
  scale_.pack(values, values_.data() + place * scale_.columns());
}

Coordinates CoordinateStore::read(std::size_t first, std::size_t count) const {
  std::vector<std::uint32_t> rows(count);
  std::iota(rows.begin(), rows.end(), static_cast<std::uint32_t>(first));
  return read(rows);
}

Coordinates CoordinateStore::read(std::span<const std::uint32_t> rows) const {
  Coordinates result{.rows = rows.size(), .columns = columns(), .values = std::vector<float>(rows.size() * columns())};
  std::vector<std::byte> room;
  const std::int16_t* block = nullptr;
  std::size_t current = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows[i];
    const std::int16_t* packed = nullptr;
    if (rest_ == nullptr) {
      packed = values_.data() + row * scale_.columns();
    } else {
      const auto above = std::lower_bound(held_.begin(), held_.end(), row);
      const auto before = static_cast<std::size_t>(above - held_.begin());
      if (above != held_.end() && *above == row) {
        packed = values_.data() + before * scale_.columns();
      } else {
        const auto place = row - before, wanted = place / RowBlocks::kRows;
        if (block == nullptr || wanted != current) block = rest_->block(current = wanted, room);
        packed = block + place % RowBlocks::kRows * scale_.columns();
      }
    }
    scale_.unpack(packed, columns(), result.values.data() + i * columns());
  }
  return result;
}

}  // namespace chiaro
