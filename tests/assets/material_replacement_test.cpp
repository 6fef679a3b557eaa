// A material of a file in place of one of a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/material_replacement.h"

namespace chiaro {
namespace {

using testing::HasSubstr;

std::string write(const std::string& name, const std::string& members) {
  writeFileAtomically(name, std::string_view(R"({"asset":{"version":"2.0"})" + members + "}"));
  return name;
}

Scene twoMaterials() {
  Scene scene;
  for (const char* name : {"wood", "brass"}) {
    Material& m = scene.materials.emplace_back();
    m.name = name;
    m.normalTexture = 3;
    m.normalScale = 0.5f;
    m.baseColorTexture = 2;
    m.doubleSided = true;
  }
  return scene;
}

void expectError(Scene scene, const std::string& name, const std::string& file, ExitCode code, const std::string& about) {
  try {
    replaceMaterial(scene, name, file);
    FAIL() << "nothing was thrown, wanted: " << about;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_THAT(std::string(error.what()), HasSubstr(about));
  }
}

TEST(ReplaceMaterial, FactorsComeFromTheFileAndReliefStays) {
  const auto file = write(
      "gold.gltf",
      R"(,"materials":[{"name":"gold","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],"metallicFactor":0,"roughnessFactor":0.25}}])");
  Scene scene = twoMaterials();
  replaceMaterial(scene, "brass", file);
  const Material& brass = scene.materials[1];
  EXPECT_EQ(brass.name, "brass");
  EXPECT_EQ(brass.baseColorFactor, glm::vec4(0.1f, 0.2f, 0.3f, 1.0f));
  EXPECT_EQ(brass.metallicFactor, 0.0f);
  EXPECT_EQ(brass.roughnessFactor, 0.25f);
  EXPECT_EQ(brass.baseColorTexture, kNone);
  EXPECT_EQ(brass.normalTexture, 3);
  EXPECT_EQ(brass.normalScale, 0.5f);
  EXPECT_TRUE(brass.doubleSided);
  EXPECT_EQ(scene.materials[0].baseColorTexture, 2);
  EXPECT_EQ(scene.materials[0].roughnessFactor, 1.0f);
}

TEST(ReplaceMaterial, RefusesWhatIsWrong) {
  const auto gold = write("gold2.gltf", R"(,"materials":[{"name":"gold"}])");
  expectError(twoMaterials(), "stone", gold, ExitCode::usage, "no material \"stone\": it has wood, brass");
  expectError(Scene{}, "stone", gold, ExitCode::usage, "the scene has no materials");
  expectError(twoMaterials(), "wood", write("empty.gltf", ""), ExitCode::unreadableInput, "empty.gltf: has no material");
  expectError(twoMaterials(), "wood", "nothing.gltf", ExitCode::unreadableInput, "nothing.gltf");
  const std::string pixel =
      "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAQAAAC1HAwCAAAAC0lEQVR42mNk+A8AAQUBAScY42YAAAAASUVORK5CYII=";
  expectError(
      twoMaterials(), "wood",
      write("textured.gltf",
            R"(,"images":[{"uri":")" + pixel +
                R"("}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"),
      ExitCode::unreadableInput, "has textures");
}

}  // namespace
}  // namespace chiaro
