// glTF 2.0 as exporters and as vandals write it.
#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "assets/scene/light_spec.h"
#include "assets/scene/load_scene.h"
#include "assets/scene/motion.h"
#include "assets/transfer/gltf_writer.h"
#include "tests/assets/asset_test_support.h"

namespace chiaro {
namespace {

using nlohmann::json;
using test::errorOf;
using test::Folder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A .gltf with its .bin beside it, made step by step.
class File {
 public:
  json root;

  File() {
    root = {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", json::array()}}}},
            {"meshes", json::array()},
            {"nodes", json::array()}};
  }

  template <class T>
  int view(const std::vector<T>& values, std::size_t stride = 0) {
    bin_.resize((bin_.size() + 3) / 4 * 4);
    json v{{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) v["byteStride"] = stride;
    const auto* data = reinterpret_cast<const std::uint8_t*>(values.data());
    bin_.insert(bin_.end(), data, data + values.size() * sizeof(T));
    root["bufferViews"].push_back(v);
    return static_cast<int>(root["bufferViews"].size() - 1);
  }
  int accessor(int bufferView, int componentType, const char* type, std::size_t count, json more = json::object()) {
    json a{{"componentType", componentType}, {"type", type}, {"count", count}};
    if (bufferView >= 0) a["bufferView"] = bufferView;
    a.update(more);
    root["accessors"].push_back(a);
    return static_cast<int>(root["accessors"].size() - 1);
  }
  int floats(const std::vector<float>& values, const char* type) {
    const std::size_t width = std::strcmp(type, "SCALAR") == 0 ? 1 : static_cast<std::size_t>(type[3] - '0');
    return accessor(view(values), 5126, type, values.size() / width);
  }
  json& primitive(json value) {
    root["meshes"].push_back({{"name", "m"}, {"primitives", {value}}});
    node({{"mesh", root["meshes"].size() - 1}});
    return root["meshes"].back()["primitives"][0];
  }
  json& node(json value) {
    root["nodes"].push_back(value);
    root["scenes"][0]["nodes"].push_back(root["nodes"].size() - 1);
    return root["nodes"].back();
  }
  /// One triangle in the z = 0 plane, seen from +z, with normals.
  json& triangle() {
    const int position = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int normal = floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    return primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  }

  Scene load() {
    warnings.clear();
    return loadScene(save("a.gltf"), [&](const std::string& line) { warnings.push_back(line); });
  }
  std::string error() {
    return errorOf([&] { load(); });
  }
  std::filesystem::path save(const std::string& name) {
    if (!bin_.empty()) root["buffers"] = {{{"uri", "a%20b.bin"}, {"byteLength", bin_.size()}}};
    test::put(folder / "a b.bin", bin_);
    return test::put(folder / name, root.dump());
  }
  /// The same as a .glb.
  std::vector<std::uint8_t> glb() {
    root["buffers"] = {{{"byteLength", bin_.size()}}};
    return GltfWriter::container(root.dump(), bin_);
  }

  std::vector<std::string> warnings;
  Folder folder;

 private:
  std::vector<std::uint8_t> bin_;
};

void expectNear(glm::vec3 a, glm::vec3 b, float tolerance = 1e-6f) {
  const float distance = glm::length(a - b);
  EXPECT_LE(distance, tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

glm::vec3 geometricNormal(const Primitive& p, std::size_t triangle = 0) {
  const auto at = [&](std::size_t k) { return p.positions[p.indices[3 * triangle + k]]; };
  return glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
}

TEST(GltfScene, TextAndBinaryGiveTheSame) {
  File file;
  file.triangle();
  const Scene text = file.load();
  const Scene binary = loadScene(test::put(file.folder / "a.GLB", file.glb()));
  for (const Scene* scene : {&text, &binary}) {
    ASSERT_EQ(scene->primitives.size(), 1u);
    EXPECT_EQ(scene->primitives[0].positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(scene->primitives[0].normals[2], glm::vec3(0, 0, 1));
    EXPECT_THAT(scene->primitives[0].indices, ElementsAre(0, 1, 2));
    EXPECT_EQ(scene->primitives[0].material, kNone);
    EXPECT_THAT(scene->meshNames, ElementsAre("m"));
  }
}

TEST(GltfScene, DataUriBuffer) {
  File file;
  file.triangle();
  file.save("a.gltf");
  file.root["buffers"] = {
      {{"byteLength", 72},
       {"uri",
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"
        "AAAAAAAAAAAAAIA/"}}};
  const Scene scene = loadScene(test::put(file.folder / "a.gltf", file.root.dump()));
  EXPECT_EQ(scene.primitives[0].positions[2], glm::vec3(0, 1, 0));
}

TEST(GltfScene, TransformsMoveNormalsByTheInverseTranspose) {
  File file;
  const int position = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 1}, "VEC3");
  const float r = std::sqrt(0.5f);
  const int normal = file.floats({0, -r, r, 0, -r, r, 0, -r, r}, "VEC3");
  const int tangent = file.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  file.primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}}}});
  // A parent that rotates by 90 degrees about x over a child that stretches y by 3.
  file.root["nodes"][0]["scale"] = {1, 3, 1};
  file.root["nodes"].push_back({{"rotation", {r, 0, 0, r}}, {"translation", {0, 0, 10}}, {"children", {0}}});
  file.root["scenes"][0]["nodes"] = {1};
  const Scene scene = file.load();
  const auto& p = scene.primitives[0];
  expectNear(p.positions[2], {0, -1, 13}, 1e-5f);  // (0,3,1) rotated: y to z, z to -y
  expectNear(p.normals[0], geometricNormal(p));
  expectNear(glm::vec3(p.tangents[0]), {1, 0, 0});
  EXPECT_EQ(p.tangents[0].w, 1.0f);
}

TEST(GltfScene, MirroredTransformKeepsTheFrontInFront) {
  File file;
  const int position = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normal = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int tangent = file.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  file.primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}}}});
  file.root["nodes"][0]["scale"] = {-2, 1, 1};
  const Scene scene = file.load();
  const auto& p = scene.primitives[0];
  expectNear(p.normals[0], {0, 0, 1});
  expectNear(geometricNormal(p), {0, 0, 1});
  // The bitangent of the mirrored frame is still where the texture's +v went: up.
  const glm::vec3 t(p.tangents[0]);
  expectNear(glm::cross(p.normals[0], t) * p.tangents[0].w, {0, 1, 0});
}

TEST(GltfScene, MatrixNodesAndZeroScale) {
  File file;
  file.triangle();
  file.root["nodes"][0]["matrix"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1};
  file.node({{"mesh", 0}, {"scale", {0, 0, 0}}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.primitives.size(), 1u);
  expectNear(scene.primitives[0].positions[1], {7, 6, 7});
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("scaled to nothing")));
}

// One axis at zero: still there, with the plane's normal, on the side from which the original was seen.
TEST(GltfScene, FlattenedMeshesStay) {
  File file;
  const float r = std::sqrt(0.5f);
  const int position = file.floats({0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}, "VEC3");
  const int normal = file.floats({0, r, -r, 0, r, -r, 0, r, -r, 0, -r, r, 0, -r, r, 0, -r, r}, "VEC3");
  file.primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  file.root["nodes"][0]["scale"] = {3, 0, 2};
  file.root["nodes"].push_back({{"children", {0}}});
  file.root["scenes"][0]["nodes"] = {1};
  for (const float angle : {0.0f, 0.7f, 2.0f, 3.0f}) {
    // Turned about x after the scale, the zero is one of rounding.
    file.root["nodes"][1]["rotation"] = {std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
    const Scene scene = file.load();
    ASSERT_EQ(scene.primitives.size(), 1u) << angle;
    EXPECT_THAT(file.warnings, testing::IsEmpty());
    const auto& p = scene.primitives[0];
    const glm::vec3 up(0, std::cos(angle), std::sin(angle));
    expectNear(p.positions[1], 2.0f * glm::vec3(0, -std::sin(angle), std::cos(angle)));
    for (std::size_t i = 0; i < 6; ++i) expectNear(p.normals[i], i < 3 ? up : -up);
    expectNear(geometricNormal(p, 0), up);
    expectNear(geometricNormal(p, 1), -up);
  }
  file.root["nodes"][0]["scale"] = {3, 0, 0};
  EXPECT_THAT(file.error(), HasSubstr("no triangles"));
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("scaled to nothing")));
}

TEST(GltfScene, InstancesAreSeparateMeshes) {
  File file;
  file.triangle();
  file.node({{"mesh", 0}, {"name", "second"}, {"translation", {0, 0, 4}}});
  const Scene scene = file.load();
  EXPECT_THAT(scene.meshNames, ElementsAre("m", "second"));
  EXPECT_EQ(scene.primitives[0].mesh, 0);
  EXPECT_EQ(scene.primitives[1].mesh, 1);
  EXPECT_EQ(scene.primitives[1].positions[0].z, 4.0f);
}

TEST(GltfScene, StripsAndFansBecomeListsWithTheSameFront) {
  for (const int mode : {5, 6}) {
    File file;
    // A square counter-clockwise from +z: strips zigzag, fans go round.
    const int position = mode == 5 ? file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3")
                                   : file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    file.primitive({{"attributes", {{"POSITION", position}}}, {"mode", mode}});
    const Scene scene = file.load();
    ASSERT_EQ(scene.triangleCount(), 2u);
    expectNear(geometricNormal(scene.primitives[0], 0), {0, 0, 1});
    expectNear(geometricNormal(scene.primitives[0], 1), {0, 0, 1});
  }
}

TEST(GltfScene, LinesAndPointsAreLeftOutWithAWarning) {
  File file;
  file.triangle();
  const int position = file.floats({0, 0, 0, 1, 0, 0}, "VEC3");
  file.primitive({{"attributes", {{"POSITION", position}}}, {"mode", 1}});
  EXPECT_EQ(file.load().primitives.size(), 1u);
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("points or lines")));
}

TEST(GltfScene, WithoutNormalsIsFlat) {
  File file;
  const int position = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  const int texcoord = file.floats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  const int index = file.accessor(file.view(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}), 5123, "SCALAR", 6);
  file.primitive({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", texcoord}}}, {"indices", index}});
  const Scene scene = file.load();
  const auto& p = scene.primitives[0];
  ASSERT_EQ(p.positions.size(), 6u);
  expectNear(p.normals[0], {0, 0, 1});
  expectNear(p.normals[3], {1, 0, 0});
  EXPECT_EQ(p.texcoords[5], glm::vec2(1, 1));
}

TEST(GltfScene, ZeroNormalsAreComputedAndLongOnesNormalised) {
  File file;
  const int position = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normal = file.floats({0, 0, 0, 0, 0, 5, 0, 0, 1}, "VEC3");
  file.primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  const Scene scene = file.load();
  for (const auto& n : scene.primitives[0].normals) expectNear(n, {0, 0, 1});
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("1 normals of zero length")));
}

TEST(GltfScene, NormalisedAndQuantisedIntegers) {
  File file;
  file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  // Interleaved shorts with a stride of 8, the fourth one padding.
  const int position =
      file.accessor(file.view(std::vector<std::int16_t>{0, 0, 0, 9, 300, 0, 0, 9, 0, -200, 0, 9}, 8), 5122, "VEC3", 3);
  const int normal = file.accessor(file.view(std::vector<std::int8_t>{0, 0, -128, 0, 0, 0, -127, 0, 0, 0, -127, 0}, 4), 5120,
                                   "VEC3", 3, {{"normalized", true}});
  const int texcoord =
      file.accessor(file.view(std::vector<std::uint16_t>{0, 65535, 32768, 0, 13107, 0}), 5123, "VEC2", 3, {{"normalized", true}});
  file.primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", texcoord}}}});
  const Scene scene = file.load();
  const auto& p = scene.primitives[0];
  EXPECT_EQ(p.positions[1], glm::vec3(300, 0, 0));
  EXPECT_EQ(p.positions[2], glm::vec3(0, -200, 0));
  EXPECT_EQ(p.normals[0], glm::vec3(0, 0, -1));
  EXPECT_EQ(p.texcoords[0], glm::vec2(0, 1));
  EXPECT_FLOAT_EQ(p.texcoords[2].x, 0.2f);
}

TEST(GltfScene, SparseAccessors) {
  File file;
  const int base = file.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices = file.view(std::vector<std::uint8_t>{2});
  const int values = file.view(std::vector<float>{0, 5, 0});
  const json sparse{
      {"count", 1}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}};
  const int position = file.accessor(base, 5126, "VEC3", 3, {{"sparse", sparse}});
  // Without a buffer view all else is zero.
  const json sparseNormal{
      {"count", 1}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}};
  const int normal = file.accessor(-1, 5126, "VEC3", 3, {{"sparse", sparseNormal}});
  file.primitive({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  const Scene scene = file.load();
  EXPECT_EQ(scene.primitives[0].positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.primitives[0].positions[2], glm::vec3(0, 5, 0));
  expectNear(scene.primitives[0].normals[2], {0, 1, 0});
  file.root["accessors"][static_cast<std::size_t>(position)]["sparse"]["count"] = 4;
  EXPECT_THAT(file.error(), HasSubstr("malformed sparse part"));
}

TEST(GltfScene, MaterialsAndTextures) {
  File file;
  file.triangle();
  const auto png = test::tinyPng();
  test::put(file.folder / "col our.png", png);
  file.root["images"] = {{{"uri", "col%20our.png"}, {"name", "colour"}},
                         {{"bufferView", file.view(test::tinyJpeg())}, {"mimeType", "image/jpeg"}}};
  file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  file.root["textures"] = {
      {{"source", 0}, {"sampler", 0}}, {{"source", 1}}, {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  file.root["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_materials_anisotropy", "KHR_materials_iridescence"};
  file.root["materials"] = {
      {{"name", "a"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 1, 1}},
         {"baseColorTexture", {{"index", 0}}},
         {"metallicFactor", 0.25},
         {"roughnessFactor", 1.5},
         {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
       {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
       {"occlusionTexture", {{"index", 2}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.25},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
         {"KHR_materials_anisotropy",
          {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1}, {"anisotropyTexture", {{"index", 1}}}}}}}}};
  file.root["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene scene = file.load();
  ASSERT_EQ(scene.materials.size(), 1u);
  const auto& m = scene.materials[0];
  EXPECT_EQ(m.baseColorFactor, glm::vec4(0.5f, 0.25f, 1, 1));
  EXPECT_EQ(m.baseColorTexture, 0);
  EXPECT_EQ(m.metallicFactor, 0.25f);
  EXPECT_EQ(m.roughnessFactor, 1.0f) << "clamped";
  EXPECT_EQ(m.metallicRoughnessTexture, kNone) << "reads TEXCOORD_1";
  EXPECT_EQ(m.normalTexture, 1);
  EXPECT_EQ(m.normalScale, 0.5f);
  EXPECT_EQ(m.occlusionTexture, kNone) << "has no image we read";
  EXPECT_EQ(m.emissiveFactor, glm::vec3(8, 4, 0));
  EXPECT_EQ(m.alphaMode, AlphaMode::mask);
  EXPECT_EQ(m.alphaCutoff, 0.25f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.anisotropyStrength, 0.5f);
  EXPECT_EQ(m.anisotropyRotation, 1.0f);
  EXPECT_EQ(m.anisotropyTexture, 1);
  EXPECT_EQ(scene.images[0].bytes, png);
  EXPECT_EQ(scene.images[0].mimeType, "image/png");
  EXPECT_EQ(scene.images[1].mimeType, "image/jpeg");
  EXPECT_EQ(scene.textures[0].wrapS, Wrap::clampToEdge);
  EXPECT_EQ(scene.textures[0].wrapT, Wrap::mirroredRepeat);
  EXPECT_TRUE(scene.textures[0].nearest);
  EXPECT_EQ(scene.textures[1].wrapS, Wrap::repeat);
  EXPECT_THAT(file.warnings, testing::IsSupersetOf({HasSubstr("KHR_materials_iridescence is ignored"), HasSubstr("TEXCOORD_1"),
                                                    HasSubstr("roughnessFactor"), HasSubstr("texture 2")}));

  std::filesystem::remove(file.folder / "col our.png");
  EXPECT_THAT(file.error(), testing::AllOf(HasSubstr("image 0 (colour) cannot be read"), HasSubstr("col our.png"),
                                           HasSubstr("put the image where")));
  test::put(file.folder / "col our.png", std::string("not an image"));
  EXPECT_THAT(file.error(), HasSubstr("image 0 (colour) is neither PNG nor JPEG"));
}

/// A triangle under a parent node; channels are of one animation.
struct Animated : File {
  int parent, child;

  Animated() {
    triangle();
    child = 0;
    root["nodes"][0]["translation"] = {0, 0, 2};
    root["nodes"].push_back({{"children", {0}}, {"translation", {1, 0, 0}}});
    parent = 1;
    root["scenes"][0]["nodes"] = {1};
  }
  void channel(int node, const char* path, const std::vector<float>& times, const std::vector<float>& values, const char* interpolation = "LINEAR") {
    json& animation = root["animations"][0];
    const int input = floats(times, "SCALAR"), output = floats(values, std::strcmp(path, "rotation") == 0 ? "VEC4" : "VEC3");
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }
};

glm::vec3 movedTo(const Scene& scene, double seconds, glm::vec3 point) { return glm::vec3(posesAt(scene, seconds).at(0) * glm::vec4(point, 1)); }

// Against the chain of nodes by hand: the child's origin rests at (1, 0, 2) in the world.
TEST(GltfMotion, ChainsOfNodesMoveRigidly) {
  Animated file;
  const float h = std::sqrt(0.5f);
  file.channel(file.parent, "rotation", {1, 3}, {0, 0, 0, 1, 0, h, 0, h});        // a quarter turn about +Y, which takes +Z to +X
  file.channel(file.child, "translation", {0, 2}, {0, 0, 2, 0, 4, 2});
  const Scene scene = file.load();
  EXPECT_THAT(file.warnings, ElementsAre());
  ASSERT_EQ(scene.motions.size(), 1u);
  EXPECT_EQ(motionSeconds(scene), 3.0);
  expectNear(movedTo(scene, -1, {1, 0, 2}), {1, 0, 2});
  expectNear(movedTo(scene, 1, {1, 0, 2}), {1, 2, 2}, 1e-5f);
  expectNear(movedTo(scene, 2, {1, 0, 2}), {1 + 2 * h, 4, 2 * h}, 1e-5f);
  expectNear(movedTo(scene, 3, {1, 0, 2}), {3, 4, 0}, 1e-5f);
  expectNear(movedTo(scene, 99, {1, 0, 2}), {3, 4, 0}, 1e-5f);
  // Between keys, where the chain is no line: half a sample of a thirtieth of a second off at most.
  const float angle = 0.37f * glm::radians(45.0f);
  expectNear(movedTo(scene, 1.37, {1, 0, 2}), {1 + 2 * std::sin(angle), 2.74f, 2 * std::cos(angle)}, 2e-4f);
}

TEST(GltfMotion, StepsAndCurves) {
  Animated file;
  file.channel(file.parent, "translation", {0, 1}, {1, 0, 0, 5, 0, 0}, "STEP");
  // In tangent, value, out tangent: from 0 at speed 6 to 2 at speed 0.
  file.channel(file.child, "translation", {0, 2}, {0, 0, 0, 0, 0, 2, 0, 6, 0, 0, 0, 0, 0, 2, 2, 0, 0, 0}, "CUBICSPLINE");
  const Scene scene = file.load();
  const auto curve = [](float t) { return 2 * (t * t * t - 2 * t * t + t) * 6 + 2 * (3 * t * t - 2 * t * t * t); };
  expectNear(movedTo(scene, 0.5, {0, 0, 0}), {0, curve(0.25f), 0}, 2e-3f);
  expectNear(movedTo(scene, 1.0, {0, 0, 0}), {4, curve(0.5f), 0}, 1e-4f);
  expectNear(movedTo(scene, 0.9, {0, 0, 0}), {0, curve(0.45f), 0}, 2e-3f);
}

TEST(GltfMotion, WhatIsNoRigidMotionRests) {
  Animated scaled;
  scaled.channel(scaled.child, "scale", {0, 1}, {1, 1, 1, 2, 1, 1});
  EXPECT_TRUE(scaled.load().motions.empty());
  EXPECT_THAT(scaled.warnings, ElementsAre(HasSubstr("more than rotation and shift")));
  Animated still;
  still.channel(still.child, "translation", {0, 1}, {0, 0, 2, 0, 0, 2});
  EXPECT_TRUE(still.load().motions.empty());
  EXPECT_THAT(still.warnings, ElementsAre());
  Animated morphed;
  morphed.channel(morphed.child, "translation", {0, 1}, {0, 0, 2, 0, 0, 3});
  morphed.root["animations"][0]["channels"][0]["target"]["path"] = "weights";
  EXPECT_TRUE(morphed.load().motions.empty());
  EXPECT_THAT(morphed.warnings, ElementsAre(HasSubstr("morph")));
  Animated two;
  two.channel(two.child, "translation", {0, 1}, {0, 0, 2, 0, 0, 3});
  two.root["animations"].push_back(two.root["animations"][0]);
  EXPECT_EQ(two.load().motions.size(), 1u);
  EXPECT_THAT(two.warnings, ElementsAre(HasSubstr("the first is kept")));
}

TEST(GltfMotion, Damaged) {
  const auto errorWith = [](const std::function<void(Animated&)>& damage) {
    Animated file;
    file.channel(file.child, "translation", {0, 1}, {0, 0, 2, 0, 0, 3});
    damage(file);
    return file.error();
  };
  EXPECT_THAT(errorWith([](Animated& f) { f.root["animations"][0]["channels"][0]["target"]["node"] = 7; }), HasSubstr("node that does not exist"));
  EXPECT_THAT(errorWith([](Animated& f) { f.root["animations"][0]["channels"][0]["sampler"] = 7; }), HasSubstr("sampler that does not exist"));
  EXPECT_THAT(errorWith([](Animated& f) { f.root["animations"][0]["samplers"][0]["input"] = f.floats({1, 1}, "SCALAR"); }), HasSubstr("do not rise"));
  EXPECT_THAT(errorWith([](Animated& f) { f.root["animations"][0]["samplers"][0]["input"] = f.floats({0, 1, 2}, "SCALAR"); }), HasSubstr("6 values for 3 times"));
  EXPECT_THAT(errorWith([](Animated& f) { f.root["animations"][0]["samplers"][0]["output"] = f.floats({0, 0, 2, 0, 0, NAN}, "VEC3"); }), HasSubstr("channel 0"));
}

// KHR_materials_ior, _specular, _clearcoat and our own extension: their members, defaults, and what is out of range.
TEST(GltfScene, ReflectanceExtensions) {
  File file;
  file.triangle();
  test::put(file.folder / "a.png", test::tinyPng());
  file.root["images"] = {{{"uri", "a.png"}}};
  file.root["textures"] = {{{"source", 0}}};
  const json reference{{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"rotation", 0.5}}}}}};
  file.root["materials"] = {
      {{"extensions",
        {{"KHR_materials_ior", {{"ior", 2}}},
         {"KHR_materials_specular",
          {{"specularFactor", 0.5}, {"specularTexture", reference}, {"specularColorFactor", {2, 1, 0}}, {"specularColorTexture", {{"index", 0}}}}},
         {"KHR_materials_clearcoat",
          {{"clearcoatFactor", 0.25},
           {"clearcoatTexture", reference},
           {"clearcoatRoughnessFactor", 0.125},
           {"clearcoatRoughnessTexture", {{"index", 0}}},
           {"clearcoatNormalTexture", {{"index", 0}}}}},
         {"CHIARO_materials_reflectance", {{"model", "ward"}, {"width", {0.25, 0.5}}, {"specularColor", {1, 0.5, 0}}}}}}},
      {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 0}}},
         {"KHR_materials_specular", json::object()},
         {"KHR_materials_clearcoat", json::object()},
         {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}},
         {"CHIARO_materials_reflectance", {{"model", "ashikhminShirley"}}}}}},
      {{"extensions", {{"CHIARO_materials_reflectance", {{"model", "blinnPhong"}, {"width", {2e6, 3}}}}}}}};
  const Scene scene = file.load();
  const auto& m = scene.materials[0];
  EXPECT_EQ(m.ior, 2.0f);
  EXPECT_NEAR(dielectricF0(m.ior), 1.0f / 9.0f, 1e-6f);
  EXPECT_EQ(m.specularFactor, 0.5f);
  EXPECT_EQ(m.specularTexture, 0);
  EXPECT_EQ(m.specularTransform.rotation, 0.5f);
  EXPECT_EQ(m.specularColorFactor, glm::vec3(2, 1, 0));
  EXPECT_EQ(m.specularColorTexture, 0);
  EXPECT_EQ(m.clearcoatFactor, 0.25f);
  EXPECT_EQ(m.clearcoatTexture, 0);
  EXPECT_EQ(m.clearcoatTransform.rotation, 0.5f);
  EXPECT_EQ(m.clearcoatRoughness, 0.125f);
  EXPECT_EQ(m.clearcoatRoughnessTexture, 0);
  EXPECT_EQ(m.reflectance, Reflectance::ward);
  EXPECT_EQ(m.reflectanceWidth, glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(m.reflectanceF0, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(reflectanceAlpha(m), glm::vec2(0.25f, 0.5f));
  const auto& plain = scene.materials[1];
  EXPECT_EQ(dielectricF0(plain.ior), 1.0f) << "0 is infinity";
  EXPECT_EQ(plain.specularFactor, 1.0f);
  EXPECT_EQ(plain.clearcoatFactor, 0.0f);
  EXPECT_FALSE(plain.reflectanceWidth || plain.reflectanceF0);
  EXPECT_EQ(reflectanceAlpha(plain), glm::vec2(0.4375f, 0.25f)) << "from roughness and anisotropy";
  EXPECT_EQ(scene.materials[2].reflectanceWidth, glm::vec2(1e6f)) << "clamped, and round";
  EXPECT_NEAR(exponentFromAlpha(reflectanceAlpha(scene.materials[2]).y), 1e6f, 1.0f);
  EXPECT_THAT(file.warnings, testing::IsSupersetOf({HasSubstr("clearcoatNormalTexture"), HasSubstr("has width 2000000")}));

  const auto errorOf = [&](const json& extension) {
    file.root["materials"] = {{{"extensions", {{"CHIARO_materials_reflectance", extension}}}}};
    return file.error();
  };
  EXPECT_THAT(errorOf({{"model", "velvet"}}), testing::AllOf(HasSubstr("unknown model \"velvet\""), HasSubstr("name one of ggx, cookTorrance")));
  EXPECT_THAT(errorOf({{"width", {1, 1}}}), HasSubstr("no model"));
  EXPECT_THAT(errorOf({{"model", "ggx"}, {"width", 0.5}}), HasSubstr("width that is not a list of 2 numbers"));
  EXPECT_THAT(errorOf({{"model", "ggx"}, {"width", {0.5, "x"}}}), HasSubstr("width that is not a list of 2 numbers"));
  EXPECT_THAT(errorOf({{"model", "ggx"}, {"width", {0, 0.5}}}), HasSubstr("a width that is not above 0"));
  EXPECT_THAT(errorOf({{"model", "ggx"}, {"specularColor", {1, 1}}}), HasSubstr("specularColor that is not a list of 3 numbers"));
}

// KHR_texture_transform, its defaults and its own texture coordinate set.
TEST(GltfScene, TextureTransforms) {
  File file;
  file.triangle();
  test::put(file.folder / "a.png", test::tinyPng());
  file.root["images"] = {{{"uri", "a.png"}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_anisotropy"};
  file.root["extensionsRequired"] = {"KHR_texture_transform"};
  const auto reference = [](const json& transform, int set = 0) {
    return json{{"index", 0}, {"texCoord", set}, {"extensions", {{"KHR_texture_transform", transform}}}};
  };
  file.root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", reference({{"offset", {0.25, -1}}, {"rotation", 0.5}, {"scale", {2, 3}}})},
         {"metallicRoughnessTexture", reference({{"scale", {1, -1}}, {"texCoord", 0}}, 1)}}},
       {"normalTexture", reference({{"texCoord", 1}})},
       {"occlusionTexture", reference({{"offset", {0, 1}}})},
       {"emissiveTexture", reference(json::object())},
       {"extensions", {{"KHR_materials_anisotropy", {{"anisotropyTexture", reference({{"rotation", -2}})}}}}}}};
  const Scene scene = file.load();
  const auto& m = scene.materials[0];
  EXPECT_EQ(m.baseColorTransform, (TextureTransform{{0.25f, -1.0f}, 0.5f, {2.0f, 3.0f}}));
  EXPECT_EQ(m.metallicRoughnessTexture, 0) << "read through TEXCOORD_0 after all";
  EXPECT_EQ(m.metallicRoughnessTransform.scale, glm::vec2(1, -1));
  EXPECT_EQ(m.normalTexture, kNone) << "read through TEXCOORD_1";
  EXPECT_EQ(m.occlusionTransform.offset, glm::vec2(0, 1));
  EXPECT_EQ(m.emissiveTransform, TextureTransform());
  EXPECT_EQ(m.anisotropyTransform.rotation, -2.0f);
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("TEXCOORD_1")));

  file.root["materials"][0]["emissiveTexture"] = reference({{"offset", {1e300, 0}}});
  EXPECT_THAT(file.error(), HasSubstr("what a float cannot hold"));
}

// Scaled first, then turned from +U towards -V, then moved: the way of Khronos' sample viewer and of KhronosGroup/glTF#1624.
TEST(GltfScene, TextureTransformsTurnCoordinatesCounterClockwise) {
  const TextureTransform transform{{10, 20}, 1.57079633f, {2, 3}};
  const glm::vec2 right = transform({1, 0}), down = transform({0, 1});
  EXPECT_LE(glm::distance(right, glm::vec2(10, 18)), 1e-5f);
  EXPECT_LE(glm::distance(down, glm::vec2(13, 20)), 1e-5f);
  const glm::vec2 kept(0.3f, -7.1f);
  EXPECT_EQ(TextureTransform()(kept), kept) << "to the bit";
}

TEST(GltfScene, CamerasAndLights) {
  File file;
  file.triangle();
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}},
                          {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
  const float r = std::sqrt(0.5f);
  file.node({{"camera", 0}, {"name", "eye"}, {"translation", {1, 2, 3}}, {"rotation", {0, r, 0, r}}, {"scale", {4, 4, 4}}});
  file.node({{"camera", 1}});
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}},
      {{"type", "spot"}, {"range", 7}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
  file.node({{"rotation", {0, r, 0, r}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.node({{"translation", {0, 9, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.cameras.size(), 2u);
  const auto& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  EXPECT_EQ(camera.verticalFov, 0.5f);
  // Rotated by 90 degrees about y, -z becomes -x; the scale must not show.
  expectNear(-glm::vec3(camera.worldFromCamera[2]), {-1, 0, 0});
  expectNear(glm::vec3(camera.worldFromCamera[1]), {0, 1, 0});
  expectNear(glm::vec3(camera.worldFromCamera[3]), {1, 2, 3});
  EXPECT_TRUE(std::isfinite(camera.farPlane));
  EXPECT_GE(camera.farPlane, 4.0f) << "an infinite projection must still hold the scene";
  EXPECT_FALSE(scene.cameras[1].perspective);
  EXPECT_EQ(scene.cameras[1].verticalExtent, 2.0f);
  ASSERT_EQ(scene.lights.size(), 2u);
  expectNear(scene.lights[0].direction, {-1, 0, 0});
  EXPECT_EQ(scene.lights[0].intensity, 3.0f);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(scene.lights[1].type, LightType::spot);
  EXPECT_EQ(scene.lights[1].position, glm::vec3(0, 9, 0));
  EXPECT_EQ(scene.lights[1].range, 7.0f);
  EXPECT_EQ(scene.lights[1].outerConeAngle, 0.2f);

  file.root["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = 2;
  EXPECT_THAT(file.error(), HasSubstr("names light 2, which does not exist"));
}

TEST(GltfScene, LightsWithASize) {
  const auto with = [](const char* type, const json& area, auto use) {
    File file;
    file.triangle();
    file.root["extensionsUsed"] = {"KHR_lights_punctual", "CHIARO_lights_area"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", type}, {"spot", json::object()}, {"extensions", {{"CHIARO_lights_area", area}}}}};
    file.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return use(file);
  };
  const auto only = [&](const char* type, const json& area) { return with(type, area, [](File& file) { return file.load().lights.at(0); }); };
  const auto refusal = [&](const char* type, const json& area) { return with(type, area, [](File& file) { return file.error(); }); };
  EXPECT_EQ(only("point", {{"radius", 0.25}}).type, LightType::sphere);
  EXPECT_EQ(only("point", {{"radius", 0.25}}).radius, 0.25f);
  EXPECT_EQ(only("point", {{"radius", 0}}).type, LightType::sphere);
  EXPECT_EQ(only("spot", {{"radius", 2}}).type, LightType::disk);
  EXPECT_EQ(only("directional", {{"angle", 0.5}}).angle, 0.5f);
  const std::string radius = "has a CHIARO_lights_area without a \"radius\" of 0 or more", angle = "without an \"angle\" between 0 and pi/2";
  for (const json& area : {json{{"radius", -1}}, json{{"radius", "1"}}, json{{"radius", 1e60}}, json{{"angle", 1}}, json(3)})
    EXPECT_THAT(refusal("point", area), HasSubstr(radius)) << area;
  for (const json& area : {json{{"angle", -0.1}}, json{{"angle", 1.6}}, json{{"radius", 1}}})
    EXPECT_THAT(refusal("directional", area), HasSubstr(angle)) << area;
}

TEST(LightSpec, SaysWhatItMeans) {
  const Light sphere = parseLightSpec("sphere,at=1,-2,.5,radius=0.25,intensity=2,4,1,range=9");
  EXPECT_EQ(sphere.type, LightType::sphere);
  EXPECT_EQ(sphere.position, glm::vec3(1, -2, 0.5f));
  EXPECT_EQ(sphere.radius, 0.25f);
  EXPECT_EQ(sphere.color * sphere.intensity, glm::vec3(2, 4, 1));
  EXPECT_EQ(sphere.range, 9.0f);
  const Light sun = parseLightSpec("sun,target=0,-2,0,angle-deg=90");
  EXPECT_EQ(sun.direction, glm::vec3(0, -1, 0));
  EXPECT_NEAR(sun.angle, 1.5707963f, 1e-6f);
  const Light disk = parseLightSpec("disk,at=0,3,0,target=0,1,0,radius=1");
  EXPECT_EQ(disk.direction, glm::vec3(0, -1, 0));
  EXPECT_GT(disk.innerConeAngle, 1.57f);
  const Light spot = parseLightSpec("spot,at=0,3,0,direction=0,0,2,cone-deg=10,20");
  EXPECT_NEAR(spot.outerConeAngle, 0.34906585f, 1e-6f);
  for (const Light& light : {sphere, sun, disk, spot, parseLightSpec("point,at=0,0,0,intensity=0")}) {
    const Light again = parseLightSpec(lightSpec(light));
    EXPECT_EQ(lightSpec(again), lightSpec(light));
    EXPECT_EQ(again.type, light.type);
  }
}

TEST(LightSpec, RefusesTheRest) {
  const std::pair<const char*, const char*> bad[] = {
      {"lamp,at=0,0,0", "is none of sun, point, spot, sphere, disk"},
      {"", "is none of"},
      {"sphere,at=0,0,0", "a sphere needs \"radius=\""},
      {"sphere,radius=1", "a sphere needs \"at=\""},
      {"sphere,at=0,0,radius=1", "at needs three numbers, not 2"},
      {"sphere,at=0,0,0,radius=-1", "radius is out of range"},
      {"sphere,at=0,0,0,radius=nan", "is not a number"},
      {"sphere,at=0,0,0,radius=1,radius=1", "is given twice"},
      {"sphere,at=0,0,0,radius=1,direction=0,0,1", "a sphere has no \"direction\""},
      {"sphere,1,2,3", "is not a number"},
      {"sphere,size=3", "unknown key \"size\""},
      {"point,at=0,0,0,intensity=-1", "must not be negative"},
      {"point,at=0,0,0,intensity=1,2", "one number or three"},
      {"point,at=0,0,0,range=0", "range must be above 0"},
      {"sun", "needs \"direction=\" or \"target=\""},
      {"sun,direction=0,0,0", "direction is zero"},
      {"sun,direction=0,1,0,angle-deg=91", "angle-deg is out of range"},
      {"disk,at=1,1,1,target=1,1,1,radius=1", "target is where the light is"},
      {"disk,at=1,1,1,target=1,1,1,direction=0,1,0,radius=1", "one of both"},
      {"spot,at=0,0,0,direction=0,1,0,cone-deg=20,10", "cone-deg is out of range"}};
  for (const auto& [text, what] : bad) EXPECT_THAT(errorOf([&, spec = text] { parseLightSpec(spec); }, ExitCode::usage), HasSubstr(what)) << text;
}

TEST(GltfScene, RequiredExtensions) {
  File file;
  file.triangle();
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(file.error(), HasSubstr("requires the glTF extension KHR_draco_mesh_compression, which is not supported"));
}

// Each damage with the words it must be reported in. POSITION is accessor 0 in buffer view 0, 36 bytes of the 72.
TEST(GltfScene, DamageIsNamed) {
  const auto broken = [](auto change) {
    File file;
    file.triangle();
    change(file.root);
    return file.error();
  };
  const std::string where = "primitive 0 of mesh 0 (m): ";
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 4; }),
              HasSubstr(where + "POSITION reaches beyond the end of buffer view 0"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 4294967295u; }), HasSubstr("POSITION reaches beyond"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["byteOffset"] = 8; }), HasSubstr("POSITION reaches beyond"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["bufferView"] = 7; }), HasSubstr("buffer view 7"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["type"] = "VEC2"; }), HasSubstr("wrong number of components"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["componentType"] = 5123; }), HasSubstr("component type 5123"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteOffset"] = 60; }), HasSubstr("reaches beyond its buffer"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteStride"] = 8; }), HasSubstr("byte stride of 8"));
  EXPECT_THAT(broken([](json& r) { r["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; }), HasSubstr("accessor 9"));
  EXPECT_THAT(broken([](json& r) { r["meshes"][0]["primitives"][0]["material"] = 0; }), HasSubstr("material 0"));
  EXPECT_THAT(broken([](json& r) {
                r["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2;
                r["accessors"].push_back(r["accessors"][1]);
                r["accessors"][2]["count"] = 2;
              }),
              HasSubstr("NORMAL has 2 elements for 3 vertices"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["mesh"] = 5; }), HasSubstr("mesh 5"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["children"] = {0}; }), HasSubstr("reached twice"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["translation"] = {1e300, 0, 0}; }), HasSubstr("where a float cannot reach"));
  EXPECT_THAT(broken([](json& r) { r["scene"] = 3; }), HasSubstr("default scene 3"));
  EXPECT_THAT(broken([](json& r) { r["scenes"][0]["nodes"] = {4}; }), HasSubstr("node 4"));
  EXPECT_THAT(broken([](json& r) { r["scenes"][0]["nodes"] = json::array(); }), HasSubstr("has no triangles"));
  EXPECT_THAT(broken([](json& r) { r["asset"]["version"] = "1.0"; }), HasSubstr("version 1.0"));
  EXPECT_THAT(broken([](json& r) { r.erase("asset"); }), HasSubstr("not a readable glTF file"));
}

TEST(GltfScene, ValuesAndIndicesOutOfRange) {
  File nan;
  const int position = nan.floats({0, 0, 0, 1, std::nanf(""), 0, 0, 1, 0}, "VEC3");
  nan.primitive({{"attributes", {{"POSITION", position}}}});
  EXPECT_THAT(nan.error(), HasSubstr("primitive 0 of mesh 0 (m): POSITION is not finite at element 1"));

  File index;
  index.triangle()["indices"] = index.accessor(index.view(std::vector<std::uint32_t>{0, 1, 3}), 5125, "SCALAR", 3);
  EXPECT_THAT(index.error(), HasSubstr("index 2 is 3, but there are only 3 vertices"));
  File two;
  two.triangle()["indices"] = two.accessor(two.view(std::vector<std::uint8_t>{0, 1}), 5121, "SCALAR", 2);
  EXPECT_THAT(two.error(), HasSubstr("not a multiple of 3"));
}

TEST(GltfScene, FilesThatAreNotThere) {
  File file;
  file.triangle();
  const auto path = file.save("a.gltf");
  std::filesystem::remove(file.folder / "a b.bin");
  EXPECT_THAT(errorOf([&] { loadScene(path); }), HasSubstr("not a readable glTF file"));
  EXPECT_THAT(errorOf([&] { loadScene(file.folder / "b.gltf"); }), HasSubstr("cannot open"));
  EXPECT_THAT(errorOf([&] { loadScene(file.folder.path()); }), HasSubstr("is a folder"));
  EXPECT_THAT(errorOf([&] { loadScene(test::put(file.folder / "a.fbx", std::string("x"))); }),
              HasSubstr("unknown file extension .fbx"));
  EXPECT_THAT(errorOf([&] { loadScene(test::put(file.folder / "e.glb", std::string())); }), HasSubstr("is empty"));
}

TEST(GltfScene, DeepJsonIsRefusedBeforeItReachesARecursiveParser) {
  const Folder folder;
  const std::string deep = "{\"asset\":{\"version\":\"2.0\",\"extras\":" + std::string(1000000, '[');
  EXPECT_THAT(errorOf([&] { loadScene(test::put(folder / "a.gltf", deep)); }), HasSubstr("nests deeper"));
}

// Thousands of damaged files: the only two outcomes are a scene and an Error.
TEST(GltfScene, RandomDamageFailsCleanly) {
  File file;
  file.triangle()["indices"] = file.accessor(file.view(std::vector<std::uint16_t>{0, 1, 2}), 5123, "SCALAR", 3);
  file.root["images"] = {{{"bufferView", file.view(test::tinyPng())}, {"mimeType", "image/png"}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.root["meshes"][0]["primitives"][0]["material"] = 0;
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}};
  file.node({{"camera", 0}});
  const auto good = file.glb();
  ASSERT_EQ(loadScene(test::put(file.folder / "a.glb", good)).triangleCount(), 1u);
  std::mt19937 random(3);
  int loaded = 0;
  for (int round = 0; round < 4000; ++round) {
    auto bytes = good;
    const int flips = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < flips; ++i) {
      auto& byte = bytes[random() % bytes.size()];
      // Digits for digits find their way deeper than noise.
      byte = byte >= '0' && byte <= '9' && random() % 4 != 0 ? static_cast<std::uint8_t>("0123456789-"[random() % 11])
                                                             : static_cast<std::uint8_t>(random());
    }
    const auto path = test::put(file.folder / "a.glb", bytes);
    ASSERT_TRUE(test::failsCleanly([&] {
      loadScene(path);
      ++loaded;
    }));
  }
  EXPECT_GE(loaded, 50) << "the damage is always fatal: the test is too weak";
  EXPECT_LE(loaded, 3950);
}

TEST(GltfScene, EvaluationPack) {
  const auto pack = test::evaluationPack();
  if (!pack) GTEST_SKIP() << "the evaluation pack is not there (set CHIARO_DATA)";
  const Scene helmet = loadScene(*pack / "clear/scenes/FlightHelmet/FlightHelmet.gltf");
  EXPECT_EQ(helmet.vertexCount(), 55392u);
  EXPECT_EQ(helmet.triangleCount(), 94722u);
  EXPECT_EQ(helmet.images.size(), 15u);
  const Scene room = loadScene(*pack / "clear/scenes/living_room/living_room.gltf");
  EXPECT_EQ(room.vertexCount(), 36233u);
  EXPECT_EQ(room.triangleCount(), 28656u);
  EXPECT_EQ(room.materials.size(), 41u);
}

}  // namespace
}  // namespace chiaro
