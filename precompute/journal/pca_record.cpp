#include "precompute/journal/pca_record.h"

#include <cstdint>
#include <cstring>

namespace chiaro {
namespace {

// The number of terms (8 bytes), the total energy, then energy, mean, functions and weights.

std::size_t sizeWith(std::size_t terms, std::size_t rows, std::size_t columns) {
  return 16 + 8 * terms + 4 * (columns + terms * columns + rows * terms);
}

}  // namespace

std::vector<std::byte> packPca(const Pca& pca) {
  std::vector<std::byte> bytes;
  const auto add = [&](const auto* values, std::size_t count) {
    const auto* first = reinterpret_cast<const std::byte*>(values);
    bytes.insert(bytes.end(), first, first + count * sizeof *values);
  };
  const auto terms = static_cast<std::uint64_t>(pca.terms);
  bytes.reserve(sizeWith(terms, terms == 0 ? 0 : pca.weights.size() / terms, pca.mean.size()));
  add(&terms, 1);
  add(&pca.totalEnergy, 1);
  add(pca.energy.data(), pca.energy.size());
  add(pca.mean.data(), pca.mean.size());
  add(pca.functions.data(), pca.functions.size());
  add(pca.weights.data(), pca.weights.size());
  return bytes;
}

bool unpackPca(std::span<const std::byte> bytes, std::size_t rows, std::size_t columns, Pca& pca) {
  pca = {};
  std::uint64_t terms = 0;
  if (bytes.size() < 16) return false;
  std::memcpy(&terms, bytes.data(), sizeof terms);
  if (terms > columns || bytes.size() != sizeWith(terms, rows, columns)) return false;
  pca.terms = static_cast<int>(terms);
  pca.energy.resize(terms);
  pca.mean.resize(columns);
  pca.functions.resize(terms * columns);
  pca.weights.resize(rows * terms);
  const auto* from = bytes.data() + sizeof terms;
  const auto take = [&](auto* values, std::size_t count) {
    if (count != 0) std::memcpy(values, from, count * sizeof *values);
    from += count * sizeof *values;
  };
  take(&pca.totalEnergy, 1);
  take(pca.energy.data(), pca.energy.size());
  take(pca.mean.data(), pca.mean.size());
  take(pca.functions.data(), pca.functions.size());
  take(pca.weights.data(), pca.weights.size());
  return true;
}

}  // namespace chiaro
