#pragma once
/// Work split into numbered blocks over threads. Which thread does a block is chance; what a block computes must not be.

#include <cstddef>
#include <functional>
#include <mutex>

namespace chiaro {

/// `threads` if positive, else the number of cores.
int threadCount(int threads);

/// Calls `block(i)` once for each i in [0, blockCount), from up to `threads` threads, and returns when all are done.
/// The first exception thrown by a block stops the rest and is thrown here.
void parallelBlocks(int threads, std::size_t blockCount, const std::function<void(std::size_t)>& block);

/// Counts finished steps of one stage for a progress handler, from any thread; calls of the handler never overlap.
class StepCounter {
 public:
  /// handler: share done in (0, 1]; may be empty, and must outlive this object.
  StepCounter(std::size_t total, const std::function<void(double)>& handler) : total_(total), handler_(handler) {}
  void add(std::size_t steps = 1);

 private:
  std::mutex mutex_;
  std::size_t count_ = 0;
  std::size_t total_;
  const std::function<void(double)>& handler_;
};

}  // namespace chiaro
