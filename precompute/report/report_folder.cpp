#include "precompute/report/report_folder.h"

#include <string>

#include "assets/error.h"
#include "assets/file.h"

namespace chiaro {
namespace {

Error folderError(const std::filesystem::path& folder, const std::string& reason) {
  return outputError(folder.string(), "the folder cannot be made: " + reason, "give another one with -o");
}

}  // namespace

void requireFolderCanBeMade(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::path standing = std::filesystem::absolute(folder, ignored).lexically_normal();
  while (!std::filesystem::exists(standing, ignored) && standing.has_relative_path()) standing = standing.parent_path();
  if (!std::filesystem::is_directory(standing, ignored)) throw folderError(folder, standing.string() + " is not a folder");
  requireWritable(standing / "index.html");
}

void makeFolder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw folderError(folder, failure.message());
}

}  // namespace chiaro
