#pragma once
/// Rows of a bake as they are traced: in memory, in the journal, or in both.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "precompute/compression/row_blocks.h"
#include "precompute/journal/journal.h"

namespace chiaro {

/// Blocks may be put from several threads, each by one.
class RowStore : public RowBlocks {
 public:
  struct Place {
    Journal* journal = nullptr;  ///< null: in memory alone
    std::uint32_t kind = 0;      ///< of its records
    bool inMemory = true;        ///< false needs a journal
  };
  /// sideBytes: of each row beside its columns.
  RowStore(std::size_t rows, std::size_t columns, std::size_t sideBytes, const Place& place);

  /// Takes what the journal has from an earlier bake: `use` gets each of those blocks, the rays it took and the side bytes of its
  /// rows. Returns the blocks that are missing, in rising order.
  std::vector<std::size_t> restore(const std::function<void(std::size_t block, std::uint64_t rays, const std::uint8_t* side)>& use);

  /// values: rowsOf(block) by columns(); side: rowsOf(block) by sideBytes.
  void put(std::size_t block, std::uint64_t rays, const std::int16_t* values, const std::uint8_t* side);

  const std::int16_t* block(std::size_t block, std::vector<std::byte>& room) const override;

 private:
  std::size_t valuesBehind(std::size_t block) const { return sizeof(std::uint64_t) + rowsOf(block) * sideBytes_; }

  std::size_t sideBytes_ = 0;
  Place place_;
  std::vector<std::int16_t> values_;
};

}  // namespace chiaro
