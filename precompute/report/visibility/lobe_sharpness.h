#pragma once
/// The lobes that every comparison of visibility asks about.

#include <array>

namespace chiaro {

inline constexpr std::array<double, 7> kLobeSharpness{3, 10, 30, 100, 300, 1000, 3000};

/// One figure at each kLobeSharpness.
using ErrorBySharpness = std::array<double, kLobeSharpness.size()>;

}  // namespace chiaro
