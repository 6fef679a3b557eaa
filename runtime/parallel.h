#pragma once
/// Independent jobs over a few threads, and nothing else.

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace chiaro {

/// Calls job(0) .. job(count - 1), each once, on `threads` threads (0: as many as the machine has). The order is not
/// defined: jobs must write to places of their own, which also makes the result the same for any thread count.
/// The first exception is rethrown here once all threads have stopped.
template <typename Job>
void parallelFor(int count, int threads, const Job& job) {
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  threads = std::min(threads, count);
  if (threads <= 1) {
    for (int i = 0; i < count; ++i) job(i);
    return;
  }
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex failureLock;
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) job(i);
    } catch (...) {
      const std::lock_guard lock(failureLock);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < threads; ++t) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace chiaro
