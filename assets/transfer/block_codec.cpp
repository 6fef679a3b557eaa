#include "assets/transfer/block_codec.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace chiaro {
namespace {

constexpr std::size_t kBlock = 16;

std::size_t blocks(std::size_t count) { return (count + kBlock - 1) / kBlock; }

template <class T>
int largest(const T* values, std::size_t count) {
  int most = 0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::abs(static_cast<int>(values[i])));
  return most;
}

/// a b / c to the nearest integer, halves away from 0; c > 0.
int scaled(int a, int b, int c) { return (2 * a * b + (a * b < 0 ? -c : c)) / (2 * c); }

int stepOf(int value, int b, int most) { return b == 0 ? 0 : std::clamp(scaled(value, most, b), -most, most); }

template <class T>
void roundBlocks(T* values, std::size_t count, int most) {
  for (std::size_t first = 0; first < count; first += kBlock) {
    const auto n = std::min(kBlock, count - first);
    const int b = largest(values + first, n);
    for (std::size_t i = first; i < first + n; ++i) values[i] = static_cast<T>(scaled(b, stepOf(values[i], b, most), most));
  }
}

int signedNibble(unsigned bits) { return static_cast<int>(bits & 15u) - ((bits & 8u) != 0 ? 16 : 0); }

}  // namespace

void roundToBlocks(std::int16_t* values, std::size_t count, int most) { roundBlocks(values, count, most); }
void roundToBlocks(std::int8_t* values, std::size_t count, int most) { roundBlocks(values, count, most); }

std::size_t blockBytes4(std::size_t count) { return blocks(count) * (1 + kBlock / 2); }

void packBlocks4(const std::int8_t* values, std::size_t count, std::vector<std::uint8_t>& out) {
  for (std::size_t first = 0; first < count; first += kBlock) {
    const auto n = std::min(kBlock, count - first);
    const int b = largest(values + first, n);
    out.push_back(static_cast<std::uint8_t>(b));
    std::int16_t q[kBlock] = {};
    for (std::size_t i = 0; i < n; ++i) q[i] = static_cast<std::int16_t>(stepOf(values[first + i], b, 7));
    packNibbles(q, kBlock, out);
  }
}

bool unpackBlocks4(const std::uint8_t* bytes, std::size_t count, std::int8_t* values) {
  for (std::size_t first = 0; first < count; first += kBlock, bytes += 1 + kBlock / 2) {
    const auto n = std::min(kBlock, count - first);
    const int b = bytes[0];
    std::int16_t q[kBlock];
    if (b > 127 || !unpackNibbles(bytes + 1, kBlock, q) || largest(q, n) != (b > 0 ? 7 : 0) || largest(q + n, kBlock - n) != 0) return false;
    for (std::size_t i = 0; i < n; ++i) values[first + i] = static_cast<std::int8_t>(scaled(b, q[i], 7));
  }
  return true;
}

std::size_t blockBytes8(std::size_t count) { return blocks(count) * (2 + kBlock); }

void packBlocks8(const std::int16_t* values, std::size_t count, std::vector<std::uint8_t>& out) {
  for (std::size_t first = 0; first < count; first += kBlock) {
    const auto n = std::min(kBlock, count - first);
    const int b = largest(values + first, n);
    out.push_back(static_cast<std::uint8_t>(b & 255));
    out.push_back(static_cast<std::uint8_t>(b >> 8));
    for (std::size_t i = 0; i < kBlock; ++i)
      out.push_back(static_cast<std::uint8_t>(i < n ? static_cast<std::int8_t>(stepOf(values[first + i], b, 127)) : 0));
  }
}

bool unpackBlocks8(const std::uint8_t* bytes, std::size_t count, std::int16_t* values) {
  for (std::size_t first = 0; first < count; first += kBlock, bytes += 2 + kBlock) {
    const auto n = std::min(kBlock, count - first);
    const int b = bytes[0] | bytes[1] << 8;
    std::int8_t q[kBlock];
    std::memcpy(q, bytes + 2, kBlock);
    if (b > 32767 || largest(q, n) != (b > 0 ? 127 : 0) || largest(q + n, kBlock - n) != 0) return false;
    for (std::size_t i = 0; i < n; ++i) values[first + i] = static_cast<std::int16_t>(scaled(b, q[i], 127));
  }
  return true;
}

void packNibbles(const std::int16_t* values, std::size_t count, std::vector<std::uint8_t>& out) {
  for (std::size_t i = 0; i < count; i += 2) {
    const unsigned low = static_cast<unsigned>(values[i]) & 15u, high = i + 1 < count ? static_cast<unsigned>(values[i + 1]) & 15u : 0u;
    out.push_back(static_cast<std::uint8_t>(low | high << 4));
  }
}

bool unpackNibbles(const std::uint8_t* bytes, std::size_t count, std::int16_t* values) {
  for (std::size_t i = 0; i < count; ++i) {
    const int q = signedNibble(static_cast<unsigned>(bytes[i / 2]) >> (i % 2 == 0 ? 0 : 4));
    if (q < -7) return false;
    values[i] = static_cast<std::int16_t>(q);
  }
  return true;
}

}  // namespace chiaro
