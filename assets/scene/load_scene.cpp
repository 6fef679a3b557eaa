#include "assets/scene/load_scene.h"

#include <new>
#include <stdexcept>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/gltf_scene.h"
#include "assets/scene/mesh_file.h"
#include "assets/scene/warnings.h"

namespace chiaro {
namespace {

Scene load(const std::filesystem::path& path, const WarningHandler& warn) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw inputError(path.string(), "is a folder", "name a file");
  static const std::string kRemedy = "convert it to .gltf, .glb, .obj, .ply, .off or .stl";
  const std::string extension = lowerCaseExtension(path);
  const bool isGltf = extension == ".gltf" || extension == ".glb";
  if (!isGltf && extension != ".obj" && extension != ".ply" && extension != ".off" && extension != ".stl")
    throw inputError(
        path.string(),
        extension.empty() ? "has no file extension to tell its format by" : "has the unknown file extension " + extension,
        kRemedy);
  const auto bytes = readFile(path);
  if (bytes.empty()) throw inputError(path.string(), "is empty", "name a scene");
  if (isGltf) return readGltfScene(bytes, path, warn);

  Warnings warnings(warn);
  if (extension == ".obj") return readObjScene(bytes, path, warnings);
  MeshImporter importer(path.string());
  if (extension == ".ply") readPly(bytes, path.string(), warnings, importer);
  if (extension == ".off") readOff(bytes, path.string(), importer);
  if (extension == ".stl") readStl(bytes, path.string(), importer);
  return sceneFromMesh(importer, path.stem().string(), warnings);
}

}  // namespace

Scene loadScene(const std::filesystem::path& path, const WarningHandler& warn) {
  try {
    Scene scene = load(path, warn);
    if (scene.triangleCount() == 0) throw inputError(path.string(), "has no triangles", "export a scene with at least one mesh");
    return scene;
  } catch (const std::bad_alloc&) {
    throw inputError(path.string(), "does not fit into memory", "use a smaller scene or a larger machine");
  } catch (const std::length_error&) {
    throw inputError(path.string(), "does not fit into memory", "use a smaller scene or a larger machine");
  }
}

}  // namespace chiaro
