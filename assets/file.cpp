#include "assets/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
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

/// A symbolic link stays and its target is replaced; a device must never be.
std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code error;
  const auto target = std::filesystem::is_symlink(path, error) ? std::filesystem::weakly_canonical(path, error) : path;
  const auto status = std::filesystem::status(target, error);
  if (std::filesystem::is_directory(status)) throw outputError(path.string(), "is a folder", "name a file");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw outputError(path.string(), "is not a regular file", "name a file");
  return target.empty() ? path : target;
}

/// The new content until it takes the target's place. Where the file system can, it has no name while it is written, so that
/// not even SIGKILL leaves anything behind; else it is a temporary file beside the target.
class Temporary {
 public:
  explicit Temporary(const std::filesystem::path& target) : target_(target) {
    // A nameless file gets its name through /proc.
    if (::access("/proc/self/fd", X_OK) == 0)
      descriptor_ = ::open(folderOf(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    name_ = target.string() + ".XXXXXX";
    descriptor_ = ::mkstemp(name_.data());
    if (descriptor_ < 0) {
      name_.clear();
      throw outputError(target.string(), "cannot create a file in this folder: " + reason(), "choose a writable folder");
    }
    // mkstemp makes the file private; give it what an ordinary new file gets.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor_, 0666 & ~mask);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  void write(std::span<const std::uint8_t> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto n = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw outputError(target_.string(), "cannot write: " + reason(), "free some space or choose another disk");
      done += static_cast<std::size_t>(n);
    }
  }

  void takeOver() {
    if (::fsync(descriptor_) != 0) throw outputError(target_.string(), "cannot flush: " + reason(), "check the disk");
    if (name_.empty() && linkAs(target_)) return flushFolder();
    for (int attempt = 0; name_.empty(); ++attempt) {
      const std::string name = target_.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt);
      if (linkAs(name))
        name_ = name;
      else if (errno != EEXIST || attempt == 100)
        fail();
    }
    if (::rename(name_.c_str(), target_.c_str()) != 0) fail();
    name_.clear();
    flushFolder();
  }

 private:
  [[noreturn]] void fail() const {
    throw outputError(target_.string(), "cannot name the finished file: " + reason(), "check the folder's permissions");
  }

  /// Gives the nameless file a name that is not taken.
  bool linkAs(const std::filesystem::path& name) const {
    const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
    return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }

  /// So that the new name outlives a power cut. Not every file system can; the content is safe either way.
  void flushFolder() const {
    const int folder = ::open(folderOf(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    ::fsync(folder);
    ::close(folder);
  }

  std::filesystem::path target_;
  std::string name_;  // empty while it has none
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
  Temporary temporary(resolved(path));
  temporary.write(bytes);
  temporary.takeOver();
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view text) {
  writeFileAtomically(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void requireWritable(const std::filesystem::path& path) {
  std::error_code error;
  const auto target = resolved(path);
  const auto folder = folderOf(target);
  if (!std::filesystem::is_directory(folder, error))
    throw outputError(path.string(), "its folder does not exist", "create " + folder.string() + " first");
  if (::access(folder.c_str(), W_OK) != 0)
    throw outputError(path.string(), "cannot write in its folder: " + reason(), "choose a writable folder");
  struct stat status {};
  if (::lstat(target.c_str(), &status) != 0 && errno != ENOENT)
    throw outputError(path.string(), "cannot be written: " + reason(), "choose another name");
  // Root may write everywhere, even where no file can be made, such as /proc.
  const Temporary probe(target);
}

bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const auto canonicalA = std::filesystem::weakly_canonical(std::filesystem::absolute(a, error), error);
  const auto canonicalB = std::filesystem::weakly_canonical(std::filesystem::absolute(b, error), error);
  return !canonicalA.empty() && canonicalA == canonicalB;
}

std::string lowerCaseExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace chiaro
