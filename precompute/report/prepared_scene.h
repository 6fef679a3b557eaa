#pragma once
/// Scenes as the studies of stored visibility take them.

#include <functional>
#include <string>

#include "assets/scene/scene.h"

namespace chiaro {

/// A file or builtin: name, as prepareScene() leaves it; ground: with addGround() under it. Throws Error: a scene without a surface is unreadable input.
Scene loadPreparedScene(const std::string& name, bool ground);

/// Whether the file holds a baked transfer.
bool isBakedFile(const std::string& nameOrPath);

/// Runs `work`; an Error of bake() about "the scene" is said of `name`.
void namingScene(const std::string& name, const std::function<void()>& work);

}  // namespace chiaro
