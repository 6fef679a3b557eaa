#pragma once

#include <chrono>
#include <ctime>

namespace chiaro {

/// What stages of a bake are timed by.
using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Of the process so far, all threads together.
inline double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace chiaro
