#include "precompute/compression/coordinates.h"

#include <algorithm>
#include <utility>

namespace chiaro {

CoordinateStore::CoordinateStore(std::size_t rows, std::vector<float> scale)
    : rows_(rows), scale_(std::move(scale)), values_(rows * scale_.size()) {}

void CoordinateStore::set(std::size_t row, const float* values) {
  auto* to = values_.data() + row * columns();
  for (std::size_t d = 0; d < columns(); ++d) {
    const float scaled = std::clamp(values[d] / scale_[d] * 32767.0f, -32767.0f, 32767.0f);
    to[d] = static_cast<std::int16_t>(scaled + (scaled < 0.0f ? -0.5f : 0.5f));
  }
}

void CoordinateStore::get(std::size_t row, float* values) const {
  const auto* from = values_.data() + row * columns();
  for (std::size_t d = 0; d < columns(); ++d) values[d] = static_cast<float>(from[d]) * (scale_[d] / 32767.0f);
}

Coordinates CoordinateStore::read(std::size_t first, std::size_t count) const {
  Coordinates result{.rows = count, .columns = columns(), .values = std::vector<float>(count * columns())};
  for (std::size_t i = 0; i < count; ++i) get(first + i, result.values.data() + i * columns());
  return result;
}

Coordinates CoordinateStore::read(const std::vector<std::uint32_t>& rows) const {
  Coordinates result{.rows = rows.size(), .columns = columns(), .values = std::vector<float>(rows.size() * columns())};
  for (std::size_t i = 0; i < rows.size(); ++i) get(rows[i], result.values.data() + i * columns());
  return result;
}

}  // namespace chiaro
