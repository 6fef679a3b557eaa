#pragma once
/// Whole-file reading, and writing that is never half done.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace chiaro {

/// The file's bytes. Throws Error (unreadableInput).
std::vector<std::uint8_t> readFile(const std::filesystem::path& path);

/// Replaces `path` by `bytes`: written beside it under a temporary name, flushed to disk, then renamed, so that a reader
/// (or a kill at any moment) sees the old file or the whole new one. Throws Error (unwritableOutput); leaves no temporary behind.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

/// Throws Error (unwritableOutput) when `path` could not be written: no such folder, no permission, or a folder itself.
/// Called before long work, so that an hour's bake is not lost to a typing mistake.
void requireWritable(const std::filesystem::path& path);

}  // namespace chiaro
