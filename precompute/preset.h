#pragma once
/// Settings by name.

#include <array>
#include <string_view>

namespace chiaro {

/// Of the joint form; everything else as BakeSettings has it. Points of the fronts that `chiaro-report sweep` measured on the built-in scene and the Stanford
/// bunny (docs/accuracy.md, "What a bake costs and buys").
struct Preset {
  std::string_view name;
  int resolution = 0;
  double bytesPerVertex = 0.0;  ///< 0: as a bake chooses, 104
};

inline constexpr std::array<Preset, 3> kPresets{{{"preview", 32, 36.0}, {"balanced", 64, 0.0}, {"quality", 64, 300.0}}};

}  // namespace chiaro
