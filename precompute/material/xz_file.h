#pragma once
/// Files packed by xz, any of its settings.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace chiaro {

/// What `stream` holds, at most `most` bytes and one more (so that too much shows). `where` names it in an Error (unreadableInput): not .xz,
/// damaged, cut short, or in need of more than 256 MiB to unpack.
std::vector<std::uint8_t> unpackedXz(std::span<const std::uint8_t> stream, std::size_t most, const std::string& where);

}  // namespace chiaro
