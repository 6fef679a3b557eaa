#pragma once
/// glTF 2.0, text or binary, as a Scene.

#include <cstdint>
#include <filesystem>
#include <span>

#include "assets/scene/load_scene.h"
#include "assets/scene/scene.h"

namespace chiaro {

/// `bytes` is the whole file; `path` names it in errors and finds what it refers to. Throws Error (unreadableInput).
Scene readGltfScene(std::span<const std::uint8_t> bytes, const std::filesystem::path& path, const WarningHandler& warn);

}  // namespace chiaro
