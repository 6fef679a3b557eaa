#include "assets/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "assets/error.h"

namespace chiaro {
namespace {

std::string reason() { return std::strerror(errno); }

std::filesystem::path folderOf(const std::filesystem::path& path) {
  const auto parent = path.parent_path();
  return parent.empty() ? std::filesystem::path(".") : parent;
}

/// Closes and removes the temporary unless the rename took it.
class Temporary {
 public:
  explicit Temporary(const std::filesystem::path& target) : name_(target.string() + ".XXXXXX") {
    descriptor_ = ::mkstemp(name_.data());
    if (descriptor_ < 0) throw outputError(target.string(), "cannot create a file in this folder: " + reason(), "choose a writable folder");
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  void write(std::span<const std::uint8_t> bytes, const std::filesystem::path& target) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto n = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw outputError(target.string(), "cannot write: " + reason(), "free some space or choose another disk");
      done += static_cast<std::size_t>(n);
    }
  }

  void renameTo(const std::filesystem::path& target) {
    // mkstemp makes the file private; give it what an ordinary new file gets.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(descriptor_, 0666 & ~mask) != 0 || ::fsync(descriptor_) != 0)
      throw outputError(target.string(), "cannot flush: " + reason(), "check the disk");
    ::close(descriptor_);
    descriptor_ = -1;
    if (::rename(name_.c_str(), target.c_str()) != 0)
      throw outputError(target.string(), "cannot rename the finished file: " + reason(), "check the folder's permissions");
    name_.clear();
  }

 private:
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace

std::vector<std::uint8_t> readFile(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw inputError(path.string(), "is a folder", "name a file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw inputError(path.string(), "cannot open: " + reason(), "check the path and its permissions");
  const auto size = static_cast<std::streamoff>(file.tellg());
  if (size < 0) throw inputError(path.string(), "cannot find its size", "name a regular file");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) throw inputError(path.string(), "cannot read it whole", "check the disk");
  return bytes;
}

void writeFileAtomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  Temporary temporary(path);
  temporary.write(bytes, path);
  temporary.renameTo(path);
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view text) {
  writeFileAtomically(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void requireWritable(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw outputError(path.string(), "is a folder", "name a file");
  const auto folder = folderOf(path);
  if (!std::filesystem::is_directory(folder, error))
    throw outputError(path.string(), "its folder does not exist", "create " + folder.string() + " first");
  if (::access(folder.c_str(), W_OK) != 0)
    throw outputError(path.string(), "cannot write in its folder: " + reason(), "choose a writable folder");
}

}  // namespace chiaro
