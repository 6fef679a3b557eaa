#include "tests/programs/view_support.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "precompute/bake.h"

extern char** environ;

namespace chiaro {
namespace {

std::string contentsOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> environmentWith(const Environ& variables) {
  std::map<std::string, std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    all[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
  }
  for (const auto& [name, value] : variables) {
    if (value.empty()) all.erase(name);
    else all[name] = value;
  }
  std::vector<std::string> lines;
  for (const auto& [name, value] : all) lines.push_back(name + "=" + value);
  return lines;
}

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Two triangles a cell, facing along cross(u, v).
void addGrid(Primitive& primitive, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int cells) {
  const auto first = static_cast<std::uint32_t>(primitive.positions.size());
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      primitive.positions.push_back(corner + u * (static_cast<float>(i) / static_cast<float>(cells)) + v * (static_cast<float>(j) / static_cast<float>(cells)));
      primitive.normals.push_back(glm::normalize(glm::cross(u, v)));
    }
  for (std::uint32_t j = 0; j + 1 < row; ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i;
      for (const std::uint32_t index : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) primitive.indices.push_back(index);
    }
}

Primitive floorOf(float half) {
  Primitive floor;
  floor.name = "floor";
  floor.material = 0;
  addGrid(floor, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, 12);
  return floor;
}

Primitive box(float half, float height) {
  Primitive primitive;
  primitive.name = "box";
  primitive.material = 1;
  const float h = half;
  addGrid(primitive, {-h, 0, h}, {2 * h, 0, 0}, {0, height, 0}, 3);
  addGrid(primitive, {h, 0, -h}, {-2 * h, 0, 0}, {0, height, 0}, 3);
  addGrid(primitive, {h, 0, h}, {0, 0, -2 * h}, {0, height, 0}, 3);
  addGrid(primitive, {-h, 0, -h}, {0, 0, 2 * h}, {0, height, 0}, 3);
  addGrid(primitive, {-h, height, h}, {2 * h, 0, 0}, {0, 0, -2 * h}, 3);
  return primitive;
}

Scene smallScene() {
  Scene scene;
  scene.meshNames = {"floor", "box"};
  scene.primitives = {floorOf(2.0f), box(0.5f, 1.2f)};
  scene.primitives[1].mesh = 1;
  scene.materials.resize(2);
  scene.materials[0].name = "stone";
  scene.materials[0].baseColorFactor = {0.7f, 0.65f, 0.6f, 1.0f};
  scene.materials[0].metallicFactor = 0.0f;
  scene.materials[0].roughnessFactor = 0.6f;
  scene.materials[1].name = "copper";
  scene.materials[1].baseColorFactor = {0.9f, 0.5f, 0.35f, 1.0f};
  scene.materials[1].roughnessFactor = 0.4f;
  // The box turns by a quarter and rises.
  scene.motions = {{1, {0.0f, 1.0f}, {glm::quat(1, 0, 0, 0), glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 1, 0))}, {glm::vec3(0.0f), glm::vec3(0.0f, 0.6f, 0.0f)}}};
  const Bounds bounds = boundsOf(scene);
  scene.cameras = {lookAt({2.5f, 2.0f, 4.0f}, {0, 0.4f, 0}, 0.7f, bounds), lookAt({-3, 3, 1}, {0, 0.4f, 0}, 0.7f, bounds)};
  scene.cameras[0].name = "front";
  scene.cameras[1].name = "side";
  return scene;
}

}  // namespace

int Finished::errorLines() const { return static_cast<int>(std::count(err.begin(), err.end(), '\n')); }

Finished runProgram(const std::string& program, const std::vector<std::string>& arguments, const Environ& variables) {
  const char* folder = std::getenv("CHIARO_BIN_DIR");
  if (folder == nullptr) throw std::runtime_error("CHIARO_BIN_DIR is not set; run this through ctest");
  std::vector<std::string> words{std::string(folder) + "/" + program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> lines = environmentWith(variables);

  const std::string stem = "run_" + std::to_string(::getpid());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, (stem + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, (stem + ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int status = posix_spawn(&child, words[0].c_str(), &actions, nullptr, pointersTo(words).data(), pointersTo(lines).data());
  posix_spawn_file_actions_destroy(&actions);
  if (status != 0) throw std::runtime_error("cannot run " + words[0]);

  int result = 0;
  ::waitpid(child, &result, 0);
  Finished finished;
  finished.code = WIFEXITED(result) ? WEXITSTATUS(result) : 128 + WTERMSIG(result);
  finished.out = contentsOf(stem + ".out");
  finished.err = contentsOf(stem + ".err");
  return finished;
}

namespace {

void bakeCoarsely(const Scene& scene, const std::filesystem::path& path) {
  BakeSettings settings;
  settings.resolution = 16;
  settings.terms = 8;
  settings.directionCount = 8;
  BakeReport report;
  writeBakedScene(path, bake(scene, settings, report), "view tests");
}

}  // namespace

void bakeSmallScene(const std::filesystem::path& path) { bakeCoarsely(smallScene(), path); }

void bakeSceneOfLamps(const std::filesystem::path& path, int count) {
  Scene scene = smallScene();
  Light lamp;
  lamp.type = LightType::point;
  lamp.position = glm::vec3(0, 3, 0);
  scene.lights.assign(static_cast<std::size_t>(count), lamp);
  bakeCoarsely(scene, path);
}

int worstDifference(const Image8& a, const Image8& b) {
  if (a.width != b.width || a.height != b.height || a.texels.size() != b.texels.size()) return 256;
  int worst = 0;
  for (std::size_t i = 0; i < a.texels.size(); ++i) worst = std::max(worst, std::abs(int{a.texels[i]} - int{b.texels[i]}));
  return worst;
}

}  // namespace chiaro
