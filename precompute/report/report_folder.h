#pragma once
/// The folder that a report is written to.

#include <filesystem>

namespace chiaro {

/// Throws Error (unwritableOutput) where makeFolder() would fail. Makes nothing: whatever else is wrong with a command leaves no empty folder behind.
void requireFolderCanBeMade(const std::filesystem::path& folder);

/// With those above it. Throws Error (unwritableOutput).
void makeFolder(const std::filesystem::path& folder);

}  // namespace chiaro
