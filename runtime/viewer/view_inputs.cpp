#include "runtime/viewer/view_inputs.h"

#include <chrono>
#include <cstdio>

#include "assets/builtin/environment.h"
#include "assets/file.h"
#include "runtime/render/renderer.h"

namespace chiaro {

double secondsNow() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

LoadedScene loadForView(const std::filesystem::path& path, const MaterialOverride& materials, const std::vector<Light>& lights) {
  const double start = secondsNow();
  LoadedScene loaded;
  loaded.path = path;
  loaded.baked = readBakedScene(path);
  nameDefaultMaterial(loaded.baked.scene);
  overrideMaterials(loaded.baked.scene, materials);
  auto& all = loaded.baked.scene.lights;
  all.insert(all.end(), lights.begin(), lights.end());
  std::error_code ignored;
  loaded.fileBytes = std::filesystem::file_size(path, ignored);
  loaded.seconds = secondsNow() - start;
  return loaded;
}

void warnOfLeftOut(const LoadedScene& scene) {
  const std::string left = leftOut(scene.baked.scene);
  if (!left.empty()) std::fprintf(stderr, "chiaro-view: warning: %s: %s\n", scene.path.c_str(), left.c_str());
}

PreparedEnvironment prepareForView(const std::string& nameOrPath, int prefilter, int threads) {
  PreparedEnvironment prepared;
  prepared.name = nameOrPath;
  const double start = secondsNow();
  const Environment environment = loadEnvironment(nameOrPath);
  prepared.loadSeconds = secondsNow() - start;
  SgEnvironmentSettings settings;
  settings.finestResolution = prefilter;
  settings.threads = threads;
  prepared.light = prepareEnvironment(environment, settings);
  prepared.exposure = autoExposure(environment);
  prepared.prepareSeconds = secondsNow() - start - prepared.loadSeconds;
  return prepared;
}

DroppedKind droppedKind(const std::filesystem::path& path) {
  const std::string extension = lowerCaseExtension(path);
  if (extension == ".glb") return DroppedKind::scene;
  if (extension == ".hdr" || extension == ".exr") return DroppedKind::environment;
  return DroppedKind::other;
}

}  // namespace chiaro
