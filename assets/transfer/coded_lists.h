#pragma once
/// The long lists of a clustered transfer as they are stored: .xz streams (docs/format.md, "Streams").

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "assets/transfer/clustered.h"

namespace chiaro {

struct Transfer;

/// Lists of a clustered transfer as they are stored: .xz streams. Empty where there is nothing in them.
struct CodedLists {
  std::vector<std::uint8_t> functions, means, components;
  std::vector<std::vector<std::uint8_t>> clusters, weights;  ///< by primitive, in the order of Transfer::primitives
  std::size_t bytes() const;
};

/// Lists are coded in parallel on up to `threads` threads (0: all); the bytes do not depend on it.
CodedLists codedLists(const Transfer& transfer, int threads = 0);

/// Whether these are lists of this transfer.
bool holds(const CodedLists& lists, const Transfer& transfer);

/// One stream. LZMA2 with 4 literal context bits and no position bits, a check of CRC32, a dictionary no larger than the bytes or 8 MiB.
std::vector<std::uint8_t> packXz(std::span<const std::uint8_t> bytes);

/// Nothing unless `stream` is one whole undamaged .xz stream of just `size` bytes that takes at most 64 MiB beside them to unpack. What no stream of
/// its length can hold is refused at once; memory is taken as bytes come.
std::optional<std::vector<std::uint8_t>> unpackXz(std::span<const std::uint8_t> stream, std::size_t size);

/// Bytes a number that stays below 2^15 in magnitude: 1, or 2: low bytes q & 255 of all, then high bytes (q + 128) >> 8 of all, rounded down and
/// modulo 256. So high bytes are 0 where |q| is small: q = int8(low) + 256 int8(high) modulo 65536.
std::vector<std::uint8_t> planesOf(std::span<const std::int16_t> values, int bytesPerValue);
std::vector<std::int16_t> valuesOfPlanes(std::span<const std::uint8_t> planes, int bytesPerValue);

/// The weights of a primitive in the order of their list: weight 0 of every vertex that has one, vertex by vertex, then weight 1, and so on.
std::vector<std::int16_t> weightsByTerm(const ClusteredVertices& vertices, const std::vector<TransferCluster>& clusters);
/// Back to ClusteredVertices::weights; vertices: their clusters alone.
std::vector<std::int16_t> weightsByVertex(const ClusteredVertices& vertices, const std::vector<TransferCluster>& clusters,
                                          const std::vector<std::int16_t>& byTerm);

}  // namespace chiaro
