#include "assets/builtin/builtin_scene.h"

#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "assets/builtin/ornament.h"
#include "assets/builtin/surface_mesh.h"
#include "assets/error.h"

namespace chiaro {
namespace {

constexpr std::string_view kPrefix = "builtin:";

/// Of radius 1 about the origin: 96 rows and 192 columns of latitude and longitude, white, dielectric, half rough.
Scene sphere() {
  Scene scene;
  Material material;
  material.name = "white";
  material.baseColorFactor = {0.8f, 0.8f, 0.8f, 1.0f};
  material.metallicFactor = 0.0f;
  material.roughnessFactor = 0.5f;
  scene.materials.push_back(material);
  scene.meshNames.emplace_back("sphere");
  Primitive primitive;
  primitive.name = "sphere";
  primitive.material = 0;
  builtin::Patch patch;
  patch.columns = 192;
  patch.rows = 96;
  builtin::addPatch(
      primitive, patch,
      [](double u, double v) {
        const double polar = std::numbers::pi * v;
        const double azimuth = 2.0 * std::numbers::pi * u;
        return glm::dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), -std::sin(polar) * std::sin(azimuth));
      },
      -1.0);
  builtin::dropUnusedVertices(primitive);
  scene.primitives.push_back(std::move(primitive));
  Camera camera = lookAt({0.0f, 0.6f, 4.2f}, {0.0f, 0.0f, 0.0f}, 0.56f, boundsOf(scene));
  camera.name = "front";
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace

const std::vector<std::string>& builtinSceneNames() {
  static const std::vector<std::string> names{"ornament", "sphere"};
  return names;
}

bool isBuiltinName(const std::string& nameOrPath) { return nameOrPath.starts_with(kPrefix); }

Scene builtinScene(const std::string& name) {
  const std::string bare = isBuiltinName(name) ? name.substr(kPrefix.size()) : name;
  if (bare == "ornament") return builtin::ornament();
  if (bare == "sphere") return sphere();
  throw usageError(std::string(kPrefix) + bare, "no built-in scene of that name", "use builtin:ornament or builtin:sphere");
}

}  // namespace chiaro
