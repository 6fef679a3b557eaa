#include "precompute/memory_budget.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "assets/error.h"

namespace chiaro {

std::size_t peakResidentBytes() {
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::size_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  if (file >> size >> resident) return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return peakResidentBytes();
}

void giveBackFreedMemory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

void MemoryBudget::require(std::size_t more) const {
  if (limit_ == 0) return;
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  const auto needed = std::max(used_ + more + kMargin, peakResidentBytes());
  if (needed <= limit_) return;
  throw usageError("--memory-limit", std::to_string(limit_ / kMiB) + " MiB are too few for this scene and these settings",
                   "give at least " + std::to_string((needed + kMiB - 1) / kMiB));
}

}  // namespace chiaro
