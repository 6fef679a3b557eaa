// OBJ, PLY, OFF and STL, well formed and not.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "assets/scene/load_scene.h"
#include "tests/assets/asset_test_support.h"

namespace chiaro {
namespace {

using test::errorOf;
using test::Folder;
using testing::ElementsAre;
using testing::HasSubstr;

Scene loadText(const std::string& name, const std::string& text, std::vector<std::string>* warnings = nullptr) {
  const Folder folder;
  return loadScene(test::put(folder / name, text), [&](const std::string& line) {
    if (warnings != nullptr) warnings->push_back(line);
  });
}

std::string errorText(const std::string& name, const std::string& text) {
  return errorOf([&] { loadText(name, text); });
}

template <class T>
void append(std::string& out, T value, bool bigEndian = false) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (bigEndian) std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

double area(const Scene& scene) {
  double sum = 0.0;
  for (const auto& p : scene.primitives)
    for (std::size_t t = 0; t < p.triangleCount(); ++t) {
      const auto at = [&](std::size_t k) { return glm::dvec3(p.positions[p.indices[3 * t + k]]); };
      sum += 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    }
  return sum;
}

const std::string kPlyVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlySquare =
    "ply\nformat ascii 1.0\ncomment a square\n" + kPlyVertices +
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

TEST(MeshScene, DefaultMaterial) {
  const Scene scene = loadText("a.ply", kPlySquare);
  const Material& m = materialOf(scene, scene.primitives[0]);
  EXPECT_EQ(m.baseColorFactor, glm::vec4(0.8f, 0.8f, 0.8f, 1.0f));
  EXPECT_EQ(m.roughnessFactor, 0.5f);
  EXPECT_EQ(m.metallicFactor, 0.0f);
  EXPECT_THAT(scene.meshNames, ElementsAre("a"));
  EXPECT_TRUE(scene.primitives[0].normals.empty());
  EXPECT_TRUE(scene.primitives[0].texcoords.empty());
}

TEST(MeshScene, PlyText) {
  const Scene scene = loadText("a.ply", kPlySquare);
  EXPECT_EQ(scene.vertexCount(), 4u);
  EXPECT_EQ(scene.triangleCount(), 2u);
  EXPECT_DOUBLE_EQ(area(scene), 1.0);
}

TEST(MeshScene, PlyBinaryWithEverything) {
  for (const bool big : {false, true}) {
    std::string text =
        std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\r\nobj_info made by a test\r\nelement camera 1\r\nproperty double angle\r\n" +
        "element vertex 3\r\nproperty uchar red\r\nproperty double x\r\nproperty float32 y\r\nproperty float z\r\nproperty short "
        "flags\r\n"
        "property float nx\r\nproperty float ny\r\nproperty float nz\r\nproperty float texture_u\r\nproperty float texture_v\r\n"
        "element face 2\r\nproperty list uint8 uint32 vertex_index\r\nproperty uchar quality\r\nelement edge 5\r\nproperty int "
        "unread\r\nend_header\r\n";
    append(text, 1.5, big);
    for (int i = 0; i < 3; ++i) {
      append(text, std::uint8_t{9}, big);
      append(text, i == 1 ? 2.0 : 0.0, big);
      append(text, i == 2 ? 3.0f : 0.0f, big);
      append(text, -1.0f, big);
      append(text, std::int16_t{7}, big);
      for (const float n : {0.0f, 0.0f, 2.0f, 0.25f, 0.75f}) append(text, n, big);
    }
    for (int f = 0; f < 2; ++f) {
      append(text, std::uint8_t{3}, big);
      for (const std::uint32_t i : {0u, 1u, 2u}) append(text, i, big);
      append(text, std::uint8_t{1}, big);
    }
    std::vector<std::string> warnings;
    const Scene scene = loadText("a.ply", text, &warnings);
    const auto& p = scene.primitives[0];
    EXPECT_EQ(p.positions[1], glm::vec3(2, 0, -1));
    EXPECT_EQ(p.positions[2], glm::vec3(0, 3, -1));
    EXPECT_EQ(p.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(p.texcoords[0], glm::vec2(0.25f, 0.25f)) << "v counts from the bottom in the file, from the top in a Scene";
    EXPECT_THAT(p.indices, ElementsAre(0, 1, 2, 0, 1, 2)) << "duplicate faces are kept";
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("vertex colours")));
  }
}

TEST(MeshScene, NonManifoldFacesAndIsolatedVerticesSurvive) {
  // Three triangles on one edge, one of them twice, one with a repeated corner, and a vertex that no face uses.
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement face 5\nproperty "
      "list uchar int vertex_indices\nend_header\n"
      "0 0 0\n0 0 1\n1 0 0\n0 1 0\n-1 0 0\n9 9 9\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 4\n3 0 0 1\n";
  const Scene scene = loadText("a.ply", ply);
  EXPECT_EQ(scene.vertexCount(), 6u);
  EXPECT_THAT(scene.primitives[0].indices, ElementsAre(0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 4, 0, 0, 1));
}

TEST(MeshScene, PlyDamage) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kPlySquare;
    text.replace(text.find(from), from.size(), to);
    return errorText("a.ply", text);
  };
  EXPECT_THAT(with("ply\n", "plx\n"), HasSubstr("PLY header is missing"));
  EXPECT_THAT(with("ascii", "morse"), HasSubstr("unknown PLY format \"morse\""));
  EXPECT_THAT(with("end_header", "end_heade"), HasSubstr("PLY header"));
  EXPECT_THAT(with("vertex 4", "vertex 4000000000"), HasSubstr("4000000000 \"vertex\" elements do not fit"));
  EXPECT_THAT(with("vertex 4", "vertex -4"), HasSubstr("malformed element count"));
  EXPECT_THAT(with("vertex 4", "vertex 5"), HasSubstr("truncated or malformed"));
  EXPECT_THAT(with("face 1", "face 2"), HasSubstr("truncated or malformed"));
  EXPECT_THAT(with("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("face 0 names vertex 4, but there are only 4"));
  EXPECT_THAT(with("4 0 1 2 3", "4 0 1 2 -1"), HasSubstr("names vertex"));
  EXPECT_THAT(with("4 0 1 2 3", "2000000000 0 1 2 3"), HasSubstr("truncated or malformed"));
  EXPECT_THAT(with("1 1 0", "1 nan 0"), HasSubstr("truncated or malformed"));
  EXPECT_THAT(with("1 1 0", "1 1e99 0"), HasSubstr("truncated or malformed"));
  EXPECT_THAT(with("float z", "flaot z"), HasSubstr("unknown type \"flaot\""));
  EXPECT_THAT(with("property float z\n", ""), HasSubstr("no x, y and z"));
  EXPECT_THAT(with("list uchar int", "list float int"), HasSubstr("list counted by \"float\""));
  EXPECT_THAT(with("vertex_indices\n", "vertex_indices\nproperty list uchar float texcoord\n"), HasSubstr("list \"texcoord\""));
  EXPECT_THAT(with("element vertex 4\n", ""), HasSubstr("property before its first element"));
  EXPECT_THAT(errorText("a.ply",
                        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement "
                        "face 0\nproperty list uchar int vertex_indices\nend_header\n"),
              HasSubstr("has no triangles"));
}

TEST(MeshScene, BinaryPlyWithNan) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
      "face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 9; ++i) append(text, i == 4 ? std::nanf("") : 0.0f);
  append(text, std::uint8_t{3});
  for (int i = 0; i < 3; ++i) append(text, i);
  EXPECT_THAT(errorText("a.ply", text), HasSubstr("not finite"));
}

TEST(MeshScene, ConcavePolygonKeepsItsShape) {
  // An arrow head: as a fan from its first corner it would cover area outside itself.
  const std::string off = "OFF\n4 1 0\n0 0 0\n2 -1 0\n0.5 0 0\n2 1 0\n4 1 2 3 0\n";
  const Scene scene = loadText("a.off", off);
  EXPECT_EQ(scene.triangleCount(), 2u);
  // Shoelace: the two triangles (0,0)-(2,-1)-(0.5,0) and its mirror image, 0.25 each.
  EXPECT_NEAR(area(scene), 0.5, 1e-6);
}

TEST(MeshScene, OffVariants) {
  const std::string square =
      "# made by hand\nOFF # plain\n\n4 2 0\n0 0 0\n1 0 0 # a comment\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0.5 0.5 0.5\n";
  const Scene plain = loadText("a.off", square);
  EXPECT_THAT(plain.primitives[0].indices, ElementsAre(0, 1, 2, 0, 2, 3)) << "face colours are skipped";
  const Scene normals = loadText("a.off", "STNOFF 3 1 0\n0 0 0 0 0 2 .25 .75\n1 0 0 0 0 1 0 0\n0 1 0 0 0 1 0 0\n3 0 1 2");
  EXPECT_EQ(normals.primitives[0].normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(normals.primitives[0].texcoords[0], glm::vec2(0.25f, 0.25f));
  const Scene colors = loadText("a.off", "COFF\r\n3 1 0\r\n0 0 0 255 0 0 255\r\n1 0 0 0 0 0 0\r\n0 1 0 1 1 1 1\r\n3 0 1 2\r\n");
  EXPECT_EQ(colors.vertexCount(), 3u);
}

TEST(MeshScene, OffDamage) {
  const std::string good = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return errorText("a.off", text);
  };
  EXPECT_THAT(with("OFF", "4OFF"), HasSubstr("not a text OFF file"));
  EXPECT_THAT(with("OFF", "OFF BINARY"), HasSubstr("not a text OFF file"));
  EXPECT_THAT(with("3 1 0", "3000000000 1 0"), HasSubstr("do not fit"));
  EXPECT_THAT(with("3 1 0", "4 1 0"), HasSubstr("ends too early"));
  EXPECT_THAT(with("3 0 1 2", "3 0 1"), HasSubstr("a.off:6: a face has too few vertices"));
  EXPECT_THAT(with("3 0 1 2", "3 0 1 3"), HasSubstr("names vertex 3 of 3"));
  EXPECT_THAT(with("3 0 1 2", "-3 0 1 2"), HasSubstr("\"-3\" is not a number it can use"));
  EXPECT_THAT(with("1 0 0", "1 inf 0"), HasSubstr("not finite"));
  EXPECT_THAT(with("1 0 0", "1 x 0"), HasSubstr("\"x\" is not a number"));
}

std::string binaryStl(const std::vector<float>& corners, std::uint32_t count) {
  std::string text = "solid of the binary kind";  // binary files may start so
  text.resize(80, ' ');
  append(text, count);
  for (std::size_t t = 0; t < corners.size() / 9; ++t) {
    for (int i = 0; i < 3; ++i) append(text, 0.0f);
    for (std::size_t i = 0; i < 9; ++i) append(text, corners[9 * t + i]);
    append(text, std::uint16_t{0});
  }
  return text;
}

const std::vector<float> kTwoTriangles{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

TEST(MeshScene, StlBinaryAndText) {
  const Scene binary = loadText("a.stl", binaryStl(kTwoTriangles, 2));
  EXPECT_EQ(binary.triangleCount(), 2u);
  EXPECT_DOUBLE_EQ(area(binary), 1.0);
  const Scene text = loadText("A.STL",
                              "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e0 "
                              "0\n  endloop\n endfacet\nendsolid a b\n");
  EXPECT_EQ(text.triangleCount(), 1u);
  EXPECT_DOUBLE_EQ(area(text), 0.5);
}

TEST(MeshScene, StlDamage) {
  EXPECT_THAT(errorText("a.stl", binaryStl(kTwoTriangles, 3)), HasSubstr("3 triangles take 234 bytes, it has 184"));
  EXPECT_THAT(errorText("a.stl", binaryStl(kTwoTriangles, 0xFFFFFFFF)),
              HasSubstr("neither a text STL file nor a whole binary one"));
  auto nan = kTwoTriangles;
  nan[4] = std::nanf("");
  EXPECT_THAT(errorText("a.stl", binaryStl(nan, 2)), HasSubstr("not finite"));
  const std::string good =
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  ASSERT_EQ(loadText("a.stl", good).triangleCount(), 1u);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return errorText("a.stl", text);
  };
  EXPECT_THAT(with("endsolid\n", ""), HasSubstr("truncated"));
  EXPECT_THAT(with("vertex 1 0 0\n", ""), HasSubstr("not three lines"));
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1 nan 0"), HasSubstr("a.stl:5: a vertex is not three finite numbers"));
  EXPECT_THAT(with("vertex 1 0 0", "vertex 1 0"), HasSubstr("three finite numbers"));
}

TEST(MeshScene, ObjSplitsCornersAndReadsMaterials) {
  const Folder folder;
  test::put(folder / "colour map.png", test::tinyPng());
  test::put(folder / "a.mtl", std::string("# library\nnewmtl red\nKd 1 0 0\nNs 1000\nd 0.5\nnewmtl wood\nKd 1 1 1\nmap_Kd colour "
                                          "map.png\nKe 2 3 4\nmap_Bump b.png\n"));
  const auto path = test::put(folder / "a.obj", std::string("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 "
                                                            "0\nvt 1 0\nvt 1 1\nvt 0.5 0.75 0\nvn 0 0 1\nvn 0 1 0\n"
                                                            "usemtl wood\nf 1/1/1 2/2/1 \\\n 3/3/1\nf -4/4/2 -2/3/1 -1/1/1\ng "
                                                            "part\nusemtl red\nf 1//1 2//1 3//1\nusemtl unknown\nf 1 2 3 4\n"));
  std::vector<std::string> warnings;
  const Scene scene = loadScene(path, [&](const std::string& line) { warnings.push_back(line); });
  ASSERT_EQ(scene.primitives.size(), 3u);
  const auto& wood = scene.primitives[0];
  EXPECT_EQ(wood.positions.size(), 5u) << "vertex 1 has two texture coordinates, vertex 3 one";
  EXPECT_THAT(wood.indices, ElementsAre(0, 1, 2, 3, 2, 4));
  EXPECT_EQ(wood.positions[3], glm::vec3(0, 0, 0));
  EXPECT_EQ(wood.texcoords[3], glm::vec2(0.5f, 0.25f));
  EXPECT_EQ(wood.normals[3], glm::vec3(0, 1, 0));
  const Material& woodMaterial = materialOf(scene, wood);
  EXPECT_EQ(woodMaterial.name, "wood");
  EXPECT_EQ(woodMaterial.emissiveFactor, glm::vec3(2, 3, 4));
  ASSERT_NE(woodMaterial.baseColorTexture, kNone);
  EXPECT_EQ(scene.images[0].bytes, test::tinyPng());
  const Material& red = materialOf(scene, scene.primitives[1]);
  EXPECT_EQ(red.baseColorFactor, glm::vec4(1, 0, 0, 0.5f));
  EXPECT_EQ(red.alphaMode, AlphaMode::blend);
  EXPECT_FLOAT_EQ(red.roughnessFactor, std::pow(2.0f / 1002.0f, 0.25f));
  EXPECT_EQ(scene.primitives[2].triangleCount(), 2u);
  EXPECT_EQ(materialOf(scene, scene.primitives[2]).name, "default");
  EXPECT_THAT(warnings,
              testing::UnorderedElementsAre(HasSubstr("map_Bump"), HasSubstr("material unknown is not in its library")));

  std::filesystem::remove(folder / "colour map.png");
  EXPECT_THAT(errorOf([&] { loadScene(path); }), testing::AllOf(HasSubstr("a.mtl:8"), HasSubstr("colour map.png")));
  std::filesystem::remove(folder / "a.mtl");
  warnings.clear();
  EXPECT_EQ(loadScene(path, [&](const std::string& line) { warnings.push_back(line); }).primitives[0].material, 0);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("material library a.mtl does not exist")));
}

TEST(MeshScene, ObjDamage) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";
  ASSERT_EQ(loadText("a.obj", good).triangleCount(), 1u);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return errorText("a.obj", text);
  };
  EXPECT_THAT(with("2/1/1", "4/1/1"), HasSubstr("a.obj:6: a face names vertex 4, but there are only 3"));
  EXPECT_THAT(with("2/1/1", "2/2/1"), HasSubstr("texture coordinate 2, but there are only 1"));
  EXPECT_THAT(with("2/1/1", "2/1/9"), HasSubstr("normal 9, but there are only 1"));
  EXPECT_THAT(with("2/1/1", "0/1/1"), HasSubstr("vertex 0"));
  EXPECT_THAT(with("2/1/1", "-4/1/1"), HasSubstr("vertex -4"));
  EXPECT_THAT(with("2/1/1", "/1/1"), HasSubstr("\"\" is not an index"));
  EXPECT_THAT(with("2/1/1", "99999999999999999999/1/1"), HasSubstr("is not an index"));
  EXPECT_THAT(with("v 1 0 0", "v 1 0"), HasSubstr("a.obj:2: \"v\" is not followed by 3 finite numbers"));
  EXPECT_THAT(with("v 1 0 0", "v 1 0 nan"), HasSubstr("finite numbers"));
  EXPECT_THAT(with("vn 0 0 1", "vn 0 inf 1"), HasSubstr("finite numbers"));
  EXPECT_THAT(with("f 1/1/1 2/1/1 3/1/1\n", "f 1 1 1\n"), HasSubstr("has no triangles"));
}

TEST(MeshScene, RandomDamageFailsCleanly) {
  std::string plyBinary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
      "face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 9; ++i) append(plyBinary, static_cast<float>(i));
  for (int f = 0; f < 2; ++f) {
    append(plyBinary, std::uint8_t{3});
    for (int i = 0; i < 3; ++i) append(plyBinary, i);
  }
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.ply", kPlySquare},
      {"b.ply", plyBinary},
      {"a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"},
      {"a.obj",
       "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl x\nf 1/1/1 2/1/1 3/1/1\nf -1//1 -2//1 -3//1\n"},
      {"a.stl", binaryStl(kTwoTriangles, 2)},
      {"b.stl",
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"}};
  const Folder folder;
  std::mt19937 random(4);
  for (const auto& [name, text] : files) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(test::failsCleanly([&] { loadScene(test::put(folder / name, text)); }));
    for (std::size_t length = 0; length < text.size(); ++length)
      ASSERT_TRUE(test::failsCleanly([&] { loadScene(test::put(folder / name, text.substr(0, length))); })) << length;
    for (int round = 0; round < 1500; ++round) {
      std::string damaged = text;
      const int flips = 1 + static_cast<int>(random() % 4);
      for (int i = 0; i < flips; ++i) {
        const std::size_t place = random() % damaged.size();
        switch (random() % 4) {
          case 0:
            damaged[place] = static_cast<char>(random());
            break;
          case 1:
            damaged[place] = "0123456789-/. \n"[random() % 15];
            break;
          case 2:
            damaged.erase(place, 1 + random() % 3);
            break;
          default:
            damaged.insert(place, 1 + random() % 3, "0123456789-/. \n"[random() % 15]);
            break;
        }
        if (damaged.empty()) break;
      }
      ASSERT_TRUE(test::failsCleanly([&] { loadScene(test::put(folder / name, damaged)); })) << damaged;
    }
  }
}

TEST(MeshScene, EvaluationPack) {
  const auto pack = test::evaluationPack();
  if (!pack) GTEST_SKIP() << "the evaluation pack is not there (set CHIARO_DATA)";
  const auto counts = [&](const std::string& name) {
    const Scene scene = loadScene(*pack / name);
    return std::pair(scene.vertexCount(), scene.triangleCount());
  };
  using Counts = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(counts("terms/meshes/bunny_69451.ply"), Counts(35947, 69451));
  EXPECT_EQ(counts("clear/meshes/snowden_109259.ply"), Counts(54559, 109259));
  EXPECT_EQ(counts("clear/meshes/teapot_992.obj"), Counts(792, 992));
  const Scene spot = loadScene(*pack / "clear/meshes/spot_5856.obj");
  EXPECT_EQ(spot.triangleCount(), 5856u);
  std::set<std::array<float, 3>> places;
  for (const auto& p : spot.primitives[0].positions) places.insert({p.x, p.y, p.z});
  EXPECT_EQ(places.size(), 2930u);
}

}  // namespace
}  // namespace chiaro
