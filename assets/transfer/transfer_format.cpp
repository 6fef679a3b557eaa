#include "assets/transfer/transfer_format.h"

#include <xxhash.h>

namespace chiaro {

std::string checksumOf(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  const XXH64_hash_t hash = XXH64(bytes.data(), bytes.size(), 0);
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[i] = kDigits[(hash >> (60 - 4 * i)) & 15];
  return text;
}

std::string checksumOf(std::string_view text) {
  return checksumOf(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string jsonChecksumMember(std::string_view digits) { return "\"jsonChecksum\":\"" + std::string(digits) + "\""; }

}  // namespace chiaro
