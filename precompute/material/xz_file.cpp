#include "precompute/material/xz_file.h"

#include <lzma.h>

#include <new>

#include "assets/error.h"

namespace chiaro {

std::vector<std::uint8_t> unpackedXz(std::span<const std::uint8_t> stream, std::size_t most, const std::string& where) {
  constexpr std::uint64_t kMostMemory = std::uint64_t{256} << 20;
  lzma_stream decoder = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&decoder, kMostMemory, LZMA_CONCATENATED) != LZMA_OK) throw std::bad_alloc();
  const struct End {
    lzma_stream& of;
    ~End() { lzma_end(&of); }
  } end{decoder};
  std::vector<std::uint8_t> bytes(most + 1);
  decoder.next_in = stream.data();
  decoder.avail_in = stream.size();
  decoder.next_out = bytes.data();
  decoder.avail_out = bytes.size();
  const auto result = lzma_code(&decoder, LZMA_FINISH);
  const bool full = result == LZMA_OK && decoder.avail_out == 0;
  if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
  if (result == LZMA_FORMAT_ERROR) throw inputError(where, "is no .xz file", "name it by what it is");
  if (result == LZMA_MEMLIMIT_ERROR)
    throw inputError(where, "needs more than 256 MiB to unpack", "unpack it with xz -d, or pack it with xz -6");
  if (result == LZMA_BUF_ERROR || (result == LZMA_OK && !full)) throw inputError(where, "is cut short", "copy it again");
  if (result != LZMA_STREAM_END && !full) throw inputError(where, "is damaged", "copy it again");
  bytes.resize(bytes.size() - decoder.avail_out);
  return bytes;
}

}  // namespace chiaro
