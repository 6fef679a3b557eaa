#pragma once
/// Scenes made by code, so that the engine shows and tests itself without any file.

#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// Names: "ornament" (the demo: an ornate object on a plinth among pillars), "sphere" (one unoccluded unit sphere).
const std::vector<std::string>& builtinSceneNames();

/// Throws Error (usage) for an unknown name.
Scene builtinScene(const std::string& name);

/// `builtin:NAME`, else a file through loadScene().
bool isBuiltinName(const std::string& nameOrPath);

}  // namespace chiaro
