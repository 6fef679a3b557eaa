#include "assets/scene/obj_material.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/image.h"
#include "assets/scene/mesh_file.h"

namespace chiaro {
namespace {

std::string restOfLine(std::istringstream& words) {
  std::string rest;
  std::getline(words >> std::ws, rest);
  while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back())) != 0) rest.pop_back();
  return rest;
}

/// The file named by a map_ statement: what follows its options (-s 1 1 1, ...), which are ignored.
std::string mapFile(const std::string& statement, const std::filesystem::path& folder) {
  std::error_code error;
  if (statement.empty() || statement[0] != '-' || std::filesystem::exists(folder / statement, error)) return statement;
  return statement.substr(statement.find_last_of(" \t") + 1);
}

int addTexture(const std::filesystem::path& file, const std::string& where, Scene& scene) {
  EncodedImage image;
  image.name = file.filename().string();
  try {
    image.bytes = readFile(file);
  } catch (const Error& error) {
    throw inputError(where, std::string("its texture cannot be read (") + error.what() + ")",
                     "put the image where the material expects it");
  }
  decodedSize(image.bytes, file.string());
  image.mimeType = image.bytes[0] == 0x89 ? "image/png" : "image/jpeg";
  scene.images.push_back(std::move(image));
  Texture texture;
  texture.image = static_cast<int>(scene.images.size() - 1);
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size() - 1);
}

glm::vec3 color(std::istringstream& words, glm::vec3 fallback) {
  glm::vec3 value(0.0f);
  words >> value.x >> value.y >> value.z;
  if (words.fail() || !std::isfinite(value.x + value.y + value.z)) return fallback;
  return glm::max(value, glm::vec3(0.0f));
}

void setOpacity(Material& material, float opacity) {
  if (!(opacity >= 0.0f && opacity < 1.0f)) return;
  material.baseColorFactor.a = opacity;
  material.alphaMode = AlphaMode::blend;
}

}  // namespace

void readMaterialLibrary(const std::filesystem::path& path, Warnings& warnings, Scene& scene,
                         std::map<std::string, int>& byName) {
  const auto bytes = readFile(path);
  std::istringstream lines(std::string(bytes.begin(), bytes.end()));
  std::map<std::string, int> textures;
  std::string line;
  Material* material = nullptr;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string where = path.string() + ":" + std::to_string(number);
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "newmtl") {
      Material fresh = defaultMeshMaterial();
      fresh.name = restOfLine(words);
      byName[fresh.name] = static_cast<int>(scene.materials.size());
      scene.materials.push_back(std::move(fresh));
      material = &scene.materials.back();
      continue;
    }
    if (material == nullptr) continue;
    float value = 0.0f;
    if (keyword == "Kd") {
      const glm::vec3 kd = glm::min(color(words, glm::vec3(material->baseColorFactor)), glm::vec3(1.0f));
      material->baseColorFactor = glm::vec4(kd, material->baseColorFactor.a);
    } else if (keyword == "Ke") {
      material->emissiveFactor = color(words, glm::vec3(0.0f));
    } else if (keyword == "d" && words >> value) {
      setOpacity(*material, value);
    } else if (keyword == "Tr" && words >> value) {
      setOpacity(*material, 1.0f - value);
    } else if (keyword == "Ns" && words >> value && value >= 0.0f && std::isfinite(value)) {
      // Same width at the peak: exponent = 2 / alpha^2 - 2 (Walter et al. 2007, section 5.2), roughness = sqrt(alpha).
      material->roughnessFactor = std::pow(2.0f / (value + 2.0f), 0.25f);
    } else if (keyword == "map_Kd") {
      const std::string file = mapFile(restOfLine(words), path.parent_path());
      if (textures.count(file) == 0) textures[file] = addTexture(path.parent_path() / file, where, scene);
      material->baseColorTexture = textures[file];
    } else if (keyword.rfind("map_", 0) == 0 || keyword == "bump" || keyword == "norm") {
      warnings.say("material statement " + keyword + " is ignored");
    }
  }
}

}  // namespace chiaro
