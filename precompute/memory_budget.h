#pragma once
/// How much memory a bake may take, asked before it takes it.

#include <cstddef>

namespace chiaro {

/// Resident bytes of this process: now, and the most there ever were.
std::size_t residentBytes();
std::size_t peakResidentBytes();

/// Lets the system have what was freed in small pieces: a mesh's tables are as large as the mesh.
void giveBackFreedMemory();

class MemoryBudget {
 public:
  /// Of what is resident now, and `limit` for the whole process; 0: no limit.
  explicit MemoryBudget(std::size_t limit = 0) : limit_(limit), used_(limit == 0 ? 0 : residentBytes()) {}

  /// Whether `more` bytes fit beside what was resident at the start.
  bool fits(std::size_t more) const { return limit_ == 0 || used_ + more + kMargin <= limit_; }
  /// Throws Error (usage) if they do not, or if the limit has been passed already; it says what would do.
  void require(std::size_t more) const;

 private:
  static constexpr std::size_t kMargin = std::size_t{16} << 20;  // stacks, small things, what allocators keep
  std::size_t limit_ = 0, used_ = 0;
};

}  // namespace chiaro
