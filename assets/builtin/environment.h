#pragma once
/// Light that comes from far away, all around: equirectangular radiance maps, built in or from files.

#include <filesystem>
#include <string>
#include <vector>

#include "assets/image/image.h"

namespace chiaro {

/// Equirectangular radiance (lobe/equirect.glsl): +Y up at the top row, the image centre looks along -Z.
struct Environment {
  std::string name;  ///< as it was asked for: a file's with its folder
  ImageRgb radiance;
};

/// Names of the built-in environments: "sunny", "overcast", "windows", "white" (radiance 1 everywhere) and "black" (none).
const std::vector<std::string>& builtinEnvironmentNames();

/// Throws Error (unreadableInput) when the name is neither built in nor that of a file. Called before long work.
void requireEnvironment(const std::string& nameOrPath);

/// A built-in environment by name, else the .hdr or .exr file of that name. Throws Error.
Environment loadEnvironment(const std::string& nameOrPath);

/// Exposure (a factor on radiance) that shows a white diffuse ball under this environment at middle brightness:
/// 0.5 pi / (mean over normals of irradiance), at most 1e12. 1 for a black environment.
float autoExposure(const Environment& environment);

}  // namespace chiaro
