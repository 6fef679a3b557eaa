#include "precompute/journal/row_store.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "assets/error.h"

namespace chiaro {

// A record: rays (8 bytes), side bytes, values.

RowStore::RowStore(std::size_t rows, std::size_t columns, std::size_t sideBytes, const Place& place)
    : RowBlocks(rows, columns), sideBytes_(sideBytes), place_(place), values_(place.inMemory ? rows * columns : 0) {
  if (place_.journal == nullptr && !place_.inMemory) throw std::invalid_argument("RowStore: rows must be somewhere");
  if (sideBytes % sizeof(std::int16_t) != 0) throw std::invalid_argument("RowStore: an odd number of side bytes");
}

std::vector<std::size_t> RowStore::restore(const std::function<void(std::size_t, std::uint64_t, const std::uint8_t*)>& use) {
  std::vector<std::size_t> missing;
  std::vector<std::byte> content;
  for (std::size_t b = 0; b < blocks(); ++b) {
    const auto values = rowsOf(b) * columns();
    if (place_.journal == nullptr || !place_.journal->read(place_.kind, b, content) || content.size() != valuesBehind(b) + 2 * values) {
      missing.push_back(b);
      continue;
    }
    std::uint64_t rays = 0;
    std::memcpy(&rays, content.data(), sizeof rays);
    use(b, rays, reinterpret_cast<const std::uint8_t*>(content.data()) + sizeof rays);
    if (place_.inMemory) std::memcpy(values_.data() + b * kRows * columns(), content.data() + valuesBehind(b), 2 * values);
  }
  return missing;
}

void RowStore::put(std::size_t block, std::uint64_t rays, const std::int16_t* values, const std::uint8_t* side) {
  const auto count = rowsOf(block) * columns();
  if (place_.inMemory) std::copy_n(values, count, values_.data() + block * kRows * columns());
  if (place_.journal == nullptr) return;
  std::vector<std::byte> content(valuesBehind(block) + 2 * count);
  std::memcpy(content.data(), &rays, sizeof rays);
  if (sideBytes_ != 0) std::memcpy(content.data() + sizeof rays, side, rowsOf(block) * sideBytes_);
  if (count != 0) std::memcpy(content.data() + valuesBehind(block), values, 2 * count);
  place_.journal->append(place_.kind, block, content);
}

const std::int16_t* RowStore::block(std::size_t block, std::vector<std::byte>& room) const {
  if (place_.inMemory) return values_.data() + block * kRows * columns();
  if (!place_.journal->read(place_.kind, block, room) || room.size() != valuesBehind(block) + 2 * rowsOf(block) * columns())
    throw inputError(place_.journal->path().string(), "what was written cannot be read back", "check the disk, then run the same command again: it makes that part anew");
  return reinterpret_cast<const std::int16_t*>(room.data() + valuesBehind(block));  // even, as room is aligned and so is what is before it
}

}  // namespace chiaro
