#include "assets/scene/glb.h"

#include <cstring>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;
constexpr int kDeepestJson = 200;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

Error truncated(const std::string& where, std::size_t expected, std::size_t found) {
  return inputError(where,
                    "the file is truncated: it has " + std::to_string(found) + " of " + std::to_string(expected) + " bytes",
                    "copy or make it again");
}

}  // namespace

bool startsLikeGlb(std::span<const std::uint8_t> bytes) { return bytes.size() >= 4 && word(bytes, 0) == kGlbMagic; }

GlbChunks parseGlb(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.size() < 4) throw truncated(where, kHeaderSize, bytes.size());
  if (!startsLikeGlb(bytes))
    throw inputError(where, "is not a binary glTF file (its first bytes are not \"glTF\")", "name a .glb file");
  if (bytes.size() < kHeaderSize) throw truncated(where, kHeaderSize, bytes.size());
  if (word(bytes, 4) != kGlbVersion)
    throw inputError(where, "has binary glTF version " + std::to_string(word(bytes, 4)) + ", not 2", "convert it to glTF 2.0");
  const std::size_t length = word(bytes, 8);
  if (length > bytes.size()) throw truncated(where, length, bytes.size());
  if (length < bytes.size())
    throw inputError(where, "has " + std::to_string(bytes.size() - length) + " bytes after its end", "copy or make it again");

  GlbChunks chunks;
  bool sawBinary = false;
  std::size_t offset = kHeaderSize;
  for (int index = 0; offset < length; ++index) {
    if (length - offset < kChunkHeaderSize) throw inputError(where, "ends inside a chunk header", "copy or make it again");
    const std::size_t size = word(bytes, offset);
    const std::uint32_t type = word(bytes, offset + 4);
    offset += kChunkHeaderSize;
    if (size > length - offset)
      throw inputError(where, "chunk " + std::to_string(index) + " is longer than the file", "copy or make it again");
    if (size % 4 != 0)
      throw inputError(where, "chunk " + std::to_string(index) + " is not a multiple of 4 bytes long", "copy or make it again");
    const auto content = bytes.subspan(offset, size);
    if ((index == 0) != (type == kGlbJsonChunk))
      throw inputError(where, "its JSON chunk is not the first", "copy or make it again");
    if (index == 0) chunks.json = {reinterpret_cast<const char*>(content.data()), content.size()};
    if (type == kGlbBinaryChunk) {
      if (sawBinary) throw inputError(where, "has two BIN chunks", "make it again");
      sawBinary = true;
      chunks.binary = content;
    }
    offset += size;
  }
  if (chunks.json.empty()) throw inputError(where, "has no JSON chunk", "copy or make it again");
  return chunks;
}

void requireShallowJson(std::string_view json, const std::string& where) {
  int depth = 0;
  bool inString = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (inString) {
      if (c == '\\') ++i;
      if (c == '"') inString = false;
    } else if (c == '"') {
      inString = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepestJson)
        throw inputError(where, "its JSON nests deeper than " + std::to_string(kDeepestJson) + " levels", "flatten it");
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

}  // namespace chiaro
