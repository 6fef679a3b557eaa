#pragma once
/// The binary glTF container (glTF 2.0, chapter 4): a header and two chunks.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace chiaro {

inline constexpr std::uint32_t kGlbMagic = 0x46546C67;  ///< "glTF"
inline constexpr std::uint32_t kGlbVersion = 2;
inline constexpr std::uint32_t kGlbJsonChunk = 0x4E4F534A;    ///< "JSON"
inline constexpr std::uint32_t kGlbBinaryChunk = 0x004E4942;  ///< "BIN\0"

/// Views into the file's bytes.
struct GlbChunks {
  std::string_view json;
  std::span<const std::uint8_t> binary;  ///< empty when the file has no BIN chunk
};

bool startsLikeGlb(std::span<const std::uint8_t> bytes);

/// Throws Error (unreadableInput) for a wrong magic or version, a truncated file, trailing bytes, or chunks that do not add up.
GlbChunks parseGlb(std::span<const std::uint8_t> bytes, const std::string& where);

/// Throws Error (unreadableInput) when brackets nest deeper than any real scene: the JSON parsers of others recurse.
void requireShallowJson(std::string_view json, const std::string& where);

}  // namespace chiaro
