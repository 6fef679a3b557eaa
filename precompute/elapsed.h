#pragma once

#include <chrono>

namespace chiaro {

/// What stages of a bake are timed by.
using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace chiaro
