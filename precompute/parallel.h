#pragma once
/// Work split into numbered blocks over threads. Which thread does a block is chance; what a block computes must not be.

#include <cstddef>
#include <functional>

namespace chiaro {

/// `threads` if positive, else the number of cores.
int threadCount(int threads);

/// Calls `block(i)` once for each i in [0, blockCount), from up to `threads` threads, and returns when all are done.
/// The first exception thrown by a block stops the rest and is thrown here.
void parallelBlocks(int threads, std::size_t blockCount, const std::function<void(std::size_t)>& block);

}  // namespace chiaro
