#pragma once
/// Principal components as a record of a journal, bit for bit.

#include <cstddef>
#include <span>
#include <vector>

#include "precompute/compression/pca.h"

namespace chiaro {

std::vector<std::byte> packPca(const Pca& pca);
/// False, and `pca` empty, if `bytes` are not components of a rows by columns matrix.
bool unpackPca(std::span<const std::byte> bytes, std::size_t rows, std::size_t columns, Pca& pca);

}  // namespace chiaro
