#pragma once
#include <array>
#include <cstdint>

namespace chiaro {

/// The colour map in which FLIP is shown: black at 0, over purple and orange, to pale yellow at 1; clamped, NaN as 0. Lightness grows evenly, so it reads
/// without colour vision too.
std::array<std::uint8_t, 3> magma(double share);

}  // namespace chiaro
