#include "precompute/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace chiaro {

int threadCount(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallelBlocks(int threads, std::size_t blockCount, const std::function<void(std::size_t)>& block) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failureMutex;

  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < blockCount; i = next++) block(i);
    } catch (...) {
      const std::lock_guard lock(failureMutex);
      if (!failure) failure = std::current_exception();
      next = blockCount;
    }
  };

  const auto count = std::min(static_cast<std::size_t>(threadCount(threads)), std::max<std::size_t>(blockCount, 1));
  {
    std::vector<std::jthread> pool;
    for (std::size_t i = 1; i < count; ++i) pool.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

void StepCounter::add(std::size_t steps) {
  if (!handler_) return;
  const std::lock_guard lock(mutex_);
  count_ += steps;
  handler_(static_cast<double>(count_) / static_cast<double>(total_));
}

}  // namespace chiaro
