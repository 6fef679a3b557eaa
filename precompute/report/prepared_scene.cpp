#include "precompute/report/prepared_scene.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "assets/builtin/builtin_scene.h"
#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/load_scene.h"
#include "assets/transfer/transfer_format.h"
#include "precompute/bake.h"
#include "precompute/report/visibility/ground.h"

namespace chiaro {

Scene loadPreparedScene(const std::string& name, bool ground) {
  Scene scene = isBuiltinName(name) ? builtinScene(name) : loadScene(name);
  if (ground) addGround(scene);
  RepairReport repairs;
  return prepareScene(std::move(scene), BakeSettings{}.creaseAngle, repairs);
}

bool isBakedFile(const std::string& nameOrPath) {
  if (isBuiltinName(nameOrPath) || std::filesystem::path(nameOrPath).extension() != ".glb") return false;
  const auto bytes = readFile(nameOrPath);
  const std::string_view name = kTransferExtension;
  return std::search(bytes.begin(), bytes.end(), name.begin(), name.end()) != bytes.end();
}

void namingScene(const std::string& name, const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.where() != "scene") throw;
    throw Error(error.code(), name, std::string(error.what()).substr(error.where().size() + 2), "");
  }
}

}  // namespace chiaro
