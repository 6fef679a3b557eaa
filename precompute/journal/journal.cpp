#include "precompute/journal/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

#include "assets/error.h"

namespace chiaro {
namespace {

constexpr std::array<char, 8> kMagic{'C', 'H', 'I', 'A', 'R', 'O', 'J', '1'};  // the last one counts versions of this layout
constexpr std::uint32_t kRecordMagic = 0x4b4c4243u;                            // CBLK

struct FileHeader {
  std::array<char, 8> magic{};
  Fingerprint fingerprint{};
  std::uint64_t checksum = 0;  ///< of what is before it
};

struct RecordHeader {
  std::uint32_t magic = kRecordMagic;
  std::uint32_t kind = 0;
  std::uint64_t index = 0, size = 0;
  std::uint64_t content = 0;   ///< the content's checksum
  std::uint64_t checksum = 0;  ///< of what is before it
};

/// Of all of a header but its last member. The place goes in, so that a stale copy elsewhere in the file is not taken for a record.
template <class Header>
std::uint64_t checksumOf(const Header& header, std::uint64_t place) {
  return XXH3_64bits_withSeed(&header, offsetof(Header, checksum), place);
}

std::string reason() { return std::strerror(errno); }

/// All of it by pread or pwrite, or false.
template <class Bytes, class Call>
bool whole(Call call, int descriptor, std::uint64_t offset, Bytes* bytes, std::size_t size) {
  while (size > 0) {
    const auto n = call(descriptor, bytes, size, static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    offset += static_cast<std::uint64_t>(n);
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool readAt(int descriptor, std::uint64_t offset, void* to, std::size_t size) {
  return whole(::pread, descriptor, offset, static_cast<std::byte*>(to), size);
}

bool writeAt(int descriptor, std::uint64_t offset, const void* from, std::size_t size) {
  return whole(::pwrite, descriptor, offset, static_cast<const std::byte*>(from), size);
}

/// Whether a file of `size` bytes starts as a journal does. Zeros, or less than all of it, are what a power cut may leave of one.
bool isOurs(int descriptor, std::size_t size) {
  std::array<char, kMagic.size() - 1> start{};  // without the version
  const auto count = static_cast<std::ptrdiff_t>(std::min(size, start.size()));
  if (!readAt(descriptor, 0, start.data(), static_cast<std::size_t>(count))) return false;
  return std::equal(start.begin(), start.begin() + count, kMagic.begin()) || std::all_of(start.begin(), start.end(), [](char c) { return c == 0; });
}

}  // namespace

Journal::Journal(std::filesystem::path path, const Fingerprint& fingerprint, bool fresh) : path_(std::move(path)) {
  // A link or a device in this place is none of ours.
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor_ < 0)
    throw outputError(path_.string(), "cannot open the file for what is finished so far: " + reason(), "choose a writable folder");
  const auto close = [&](const std::string& problem, const std::string& remedy) {
    ::close(descriptor_);
    return outputError(path_.string(), problem, remedy);
  };
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) throw close("is not a regular file", "choose another name for the output");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw close("another bake is writing to it", "wait for that one, or choose another name for the output");
  if (!isOurs(descriptor_, static_cast<std::size_t>(status.st_size)))
    throw close("is there already, and is not what a bake leaves to go on from", "move it away");
  if (status.st_size > 0 && !fresh) found_ = scan(fingerprint) ? Found::same : Found::other;
  if (found_ == Found::same) return;
  try {
    start(fingerprint);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  if (records_.empty()) ::unlink(path_.c_str());
  ::close(descriptor_);
}

void Journal::start(const Fingerprint& fingerprint) {
  FileHeader header{.magic = kMagic, .fingerprint = fingerprint};
  header.checksum = checksumOf(header, 0);
  if (::ftruncate(descriptor_, 0) != 0 || !writeAt(descriptor_, 0, &header, sizeof header))
    throw outputError(path_.string(), "cannot write: " + reason(), "free some space or choose another disk");
  end_ = sizeof header;
}

bool Journal::scan(const Fingerprint& fingerprint) {
  struct stat status {};
  FileHeader file;
  if (::fstat(descriptor_, &status) != 0 || !readAt(descriptor_, 0, &file, sizeof file)) return false;
  if (file.magic != kMagic || file.checksum != checksumOf(file, 0) || file.fingerprint != fingerprint) return false;
  const auto size = static_cast<std::uint64_t>(status.st_size);
  end_ = sizeof file;
  RecordHeader record;
  // Contents are judged when they are read; a damaged one costs itself alone, a damaged header all that is behind it.
  while (size - end_ >= sizeof record && readAt(descriptor_, end_, &record, sizeof record)) {
    if (record.magic != kRecordMagic || record.checksum != checksumOf(record, end_) || record.size > size - end_ - sizeof record) break;
    records_[{record.kind, record.index}] = {end_ + sizeof record, record.size, record.content};
    end_ += sizeof record + record.size;
  }
  return ::ftruncate(descriptor_, static_cast<off_t>(end_)) == 0;
}

bool Journal::has(std::uint32_t kind, std::uint64_t index) const {
  const std::lock_guard lock(mutex_);
  return records_.count({kind, index}) != 0;
}

void Journal::append(std::uint32_t kind, std::uint64_t index, std::span<const std::byte> content) {
  RecordHeader record{.kind = kind, .index = index, .size = content.size(), .content = XXH3_64bits(content.data(), content.size())};
  // One after the other: a kill can only tear the last record.
  const std::lock_guard lock(mutex_);
  record.checksum = checksumOf(record, end_);
  if (!writeAt(descriptor_, end_, &record, sizeof record) || !writeAt(descriptor_, end_ + sizeof record, content.data(), content.size()))
    throw outputError(path_.string(), "cannot write: " + reason(), "free some space and run the same command again: it goes on from there");
  records_[{kind, index}] = {end_ + sizeof record, record.size, record.content};
  end_ += sizeof record + record.size;
}

bool Journal::read(std::uint32_t kind, std::uint64_t index, std::vector<std::byte>& content) const {
  Place place;
  {
    const std::lock_guard lock(mutex_);
    const auto found = records_.find({kind, index});
    if (found == records_.end()) return false;
    place = found->second;
  }
  content.resize(place.size);
  if (readAt(descriptor_, place.offset, content.data(), content.size()) && XXH3_64bits(content.data(), content.size()) == place.checksum) return true;
  const std::lock_guard lock(mutex_);
  records_.erase({kind, index});
  return false;
}

}  // namespace chiaro
