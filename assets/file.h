#pragma once
/// Whole-file reading, and writing that is never half done.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace chiaro {

/// The file's bytes. Throws Error (unreadableInput).
std::vector<std::uint8_t> readFile(const std::filesystem::path& path);

/// Replaces `path` by `bytes`: written to a nameless (else temporary) file in its folder, flushed to disk, then put in place,
/// so that a reader (or a kill at any moment) sees the old file or the whole new one. Leaves nothing else behind, but for a
/// kill between the last two system calls, which leaves a second whole copy. Throws Error (unwritableOutput).
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

/// Throws Error (unwritableOutput) when `path` could not be written: no such folder, no permission, a name that is too long, or
/// a folder itself. Called before long work, so that an hour's bake is not lost to a typing mistake. Leaves nothing behind.
void requireWritable(const std::filesystem::path& path);

/// Whether both paths lead to one file, however they are spelt and through whatever links. Neither needs to exist.
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// With its dot, ".glb" of "A.GLB"; empty without one.
std::string lowerCaseExtension(const std::filesystem::path& path);

}  // namespace chiaro
