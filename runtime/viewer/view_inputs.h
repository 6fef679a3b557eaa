#pragma once
/// A scene and an environment on their way from file to renderer, with the seconds they took.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "assets/scene/material_override.h"
#include "assets/transfer/transfer.h"
#include "runtime/environment/sg_environment.h"

namespace chiaro {

struct LoadedScene {
  std::filesystem::path path;
  BakedScene baked;              ///< every primitive has a material of its own or of the file
  std::uintmax_t fileBytes = 0;
  double seconds = 0.0;
};

/// Reads, overrides and adds lights behind the file's own. Throws Error (unreadableInput).
LoadedScene loadForView(const std::filesystem::path& path, const MaterialOverride& materials, const std::vector<Light>& lights);

/// One line on standard error when the renderer will leave something of the scene out.
void warnOfLeftOut(const LoadedScene& scene);

struct PreparedEnvironment {
  std::string name;              ///< as the user gave it
  SgEnvironment light;
  float exposure = 1.0f;         ///< autoExposure()
  double loadSeconds = 0.0;
  double prepareSeconds = 0.0;
};

/// Loads and prefilters; prefilter: SgEnvironmentSettings::finestResolution. Throws Error (unreadableInput).
PreparedEnvironment prepareForView(const std::string& nameOrPath, int prefilter, int threads);

enum class DroppedKind { scene, environment, other };
/// What a file dropped on the window is taken for, by its extension (case ignored).
DroppedKind droppedKind(const std::filesystem::path& path);

/// Seconds since the steady clock's start.
double secondsNow();

}  // namespace chiaro
