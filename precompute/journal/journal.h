#pragma once
/// What a bake has finished so far, in one file: a bake that was stopped or killed goes on from it, and blocks that memory has no room
/// for are read back from it.
///
/// The file is a header with a fingerprint of everything that shapes its content, then records, appended in whatever order threads
/// finish them. Header, record headers and contents carry checksums (XXH3). A record is never changed. What a kill, a full disk or a
/// power cut tore is noticed when it is read, and made anew.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace chiaro {

using Fingerprint = std::array<std::uint64_t, 2>;

class Journal {
 public:
  /// What an earlier bake had left in its place.
  enum class Found { nothing, same, other };

  /// Opens the file at `path` and keeps its records, or starts it anew where there is none, where it has another fingerprint, or where
  /// `fresh` says so. Throws Error (unwritableOutput): it cannot be made, or another process has it open.
  Journal(std::filesystem::path path, const Fingerprint& fingerprint, bool fresh = false);
  /// The file stays if it has records.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::filesystem::path& path() const { return path_; }
  Found found() const { return found_; }

  bool has(std::uint32_t kind, std::uint64_t index) const;

  /// Thread safe. Throws Error (unwritableOutput) when the disk says no; what was there before stays whole.
  void append(std::uint32_t kind, std::uint64_t index, std::span<const std::byte> content);

  /// Thread safe. False, and from then on has() is false, when there is no such record or its content does not match its checksum.
  bool read(std::uint32_t kind, std::uint64_t index, std::vector<std::byte>& content) const;

 private:
  struct Place {
    std::uint64_t offset = 0, size = 0, checksum = 0;
  };
  bool scan(const Fingerprint& fingerprint);
  void start(const Fingerprint& fingerprint);

  std::filesystem::path path_;
  int descriptor_ = -1;
  Found found_ = Found::nothing;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<std::uint32_t, std::uint64_t>, Place> records_;
  std::uint64_t end_ = 0;
};

}  // namespace chiaro
