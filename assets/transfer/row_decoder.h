#pragma once
/// Rows of single vertices, summed when they are asked for: little memory, so for a few vertices among many.

#include <cstddef>
#include <vector>

#include "assets/transfer/transfer.h"

namespace chiaro {

/// Of a clustered transfer, which must outlive it.
class RowDecoder {
 public:
  explicit RowDecoder(const Transfer& transfer);
  /// row += share * what is stored for `vertex` (numbered through all primitives); #Transfer::columns() values.
  void add(std::size_t vertex, float share, float* row) const;

 private:
  const Transfer& transfer_;
  std::vector<float> functions_;
  std::vector<std::vector<std::size_t>> firstWeight_;  // by primitive
};

}  // namespace chiaro
