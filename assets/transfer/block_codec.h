#pragma once
/// Integers in blocks of 16 that share their largest magnitude b: one of few bits, q, stands for round(b q / most). Values in memory are
/// those that survive this unchanged, so nothing is lost between memory and file (docs/format.md, "Blocks").

#include <cstddef>
#include <cstdint>
#include <vector>

namespace chiaro {

/// Every value replaced by the nearest one that its block can hold: `most` steps to either side, 7 (4 bits) or 127 (8 bits).
void roundToBlocks(std::int16_t* values, std::size_t count, int most);
void roundToBlocks(std::int8_t* values, std::size_t count, int most);

/// Signed bytes, 4 bits each: per block a byte b in [0, 127], then 8 bytes of two q in [-7, 7], the low one first. The last block is whole.
std::size_t blockBytes4(std::size_t count);
void packBlocks4(const std::int8_t* values, std::size_t count, std::vector<std::uint8_t>& out);
/// False where b or a q is out of its range, or no q of a block has the magnitude of the largest (0 where b is).
bool unpackBlocks4(const std::uint8_t* bytes, std::size_t count, std::int8_t* values);

/// 16-bit integers, 8 bits each: per block b in [0, 32767], low byte first, then 16 signed bytes q in [-127, 127]. The last block is whole.
std::size_t blockBytes8(std::size_t count);
void packBlocks8(const std::int16_t* values, std::size_t count, std::vector<std::uint8_t>& out);
bool unpackBlocks8(const std::uint8_t* bytes, std::size_t count, std::int16_t* values);

/// Two signed 4-bit numbers in [-7, 7] a byte, the low one first; the last byte may hold one.
void packNibbles(const std::int16_t* values, std::size_t count, std::vector<std::uint8_t>& out);
bool unpackNibbles(const std::uint8_t* bytes, std::size_t count, std::int16_t* values);

}  // namespace chiaro
