// The baked file: what goes in comes out, and nothing that was damaged gets in.
#include "assets/transfer/transfer.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "assets/scene/glb.h"
#include "assets/scene/load_scene.h"
#include "assets/transfer/gltf_writer.h"
#include "assets/transfer/transfer_format.h"
#include "tests/assets/asset_test_support.h"

namespace chiaro {
namespace {

using test::errorOf;
using test::Folder;
using testing::HasSubstr;

std::vector<std::uint8_t> bytesOf(const BakedScene& baked) {
  const Folder folder;
  writeBakedScene(folder / "a.glb", baked, "test");
  return test::get(folder / "a.glb");
}

BakedScene readBytes(std::span<const std::uint8_t> bytes) {
  const Folder folder;
  return readBakedScene(test::put(folder / "a.glb", bytes));
}

template <class T>
void expectSameBits(const std::vector<T>& a, const std::vector<T>& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

void expectSame(const Material& a, const Material& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.baseColorFactor, b.baseColorFactor);
  EXPECT_EQ(a.baseColorTexture, b.baseColorTexture);
  EXPECT_EQ(a.metallicFactor, b.metallicFactor);
  EXPECT_EQ(a.roughnessFactor, b.roughnessFactor);
  EXPECT_EQ(a.metallicRoughnessTexture, b.metallicRoughnessTexture);
  EXPECT_EQ(a.normalTexture, b.normalTexture);
  EXPECT_EQ(a.normalScale, b.normalScale);
  EXPECT_EQ(a.occlusionTexture, b.occlusionTexture);
  EXPECT_EQ(a.occlusionStrength, b.occlusionStrength);
  EXPECT_EQ(a.emissiveFactor, b.emissiveFactor);
  EXPECT_EQ(a.emissiveTexture, b.emissiveTexture);
  EXPECT_EQ(a.alphaMode, b.alphaMode);
  EXPECT_EQ(a.alphaCutoff, b.alphaCutoff);
  EXPECT_EQ(a.doubleSided, b.doubleSided);
  EXPECT_EQ(a.anisotropyStrength, b.anisotropyStrength);
  EXPECT_EQ(a.anisotropyRotation, b.anisotropyRotation);
  EXPECT_EQ(a.anisotropyTexture, b.anisotropyTexture);
  EXPECT_EQ(a.baseColorTransform, b.baseColorTransform);
  EXPECT_EQ(a.metallicRoughnessTransform, b.metallicRoughnessTransform);
  EXPECT_EQ(a.normalTransform, b.normalTransform);
  EXPECT_EQ(a.occlusionTransform, b.occlusionTransform);
  EXPECT_EQ(a.emissiveTransform, b.emissiveTransform);
  EXPECT_EQ(a.anisotropyTransform, b.anisotropyTransform);
}

void expectSame(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.worldFromCamera, b.worldFromCamera);
  EXPECT_EQ(a.perspective, b.perspective);
  EXPECT_EQ(a.verticalFov, b.verticalFov);
  EXPECT_EQ(a.verticalExtent, b.verticalExtent);
  EXPECT_EQ(a.nearPlane, b.nearPlane);
  EXPECT_EQ(a.farPlane, b.farPlane);
}

void expectSame(const Light& a, const Light& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.range, b.range);
  EXPECT_EQ(a.innerConeAngle, b.innerConeAngle);
  EXPECT_EQ(a.outerConeAngle, b.outerConeAngle);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.direction, b.direction);
}

void expectSame(const BakedScene& a, const BakedScene& b) {
  EXPECT_EQ(a.scene.meshNames, b.scene.meshNames);
  ASSERT_EQ(a.scene.primitives.size(), b.scene.primitives.size());
  ASSERT_EQ(a.transfer.primitives.size(), b.transfer.primitives.size());
  for (std::size_t i = 0; i < a.scene.primitives.size(); ++i) {
    const auto &p = a.scene.primitives[i], &q = b.scene.primitives[i];
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.mesh, q.mesh);
    EXPECT_EQ(p.material, q.material);
    expectSameBits(p.positions, q.positions, "positions");
    expectSameBits(p.normals, q.normals, "normals");
    expectSameBits(p.tangents, q.tangents, "tangents");
    expectSameBits(p.texcoords, q.texcoords, "texcoords");
    expectSameBits(p.indices, q.indices, "indices");
    expectSameBits(a.transfer.primitives[i].weights, b.transfer.primitives[i].weights, "weights");
    expectSameBits(a.transfer.primitives[i].visibility, b.transfer.primitives[i].visibility, "visibility");
  }
  ASSERT_EQ(a.scene.materials.size(), b.scene.materials.size());
  for (std::size_t i = 0; i < a.scene.materials.size(); ++i) expectSame(a.scene.materials[i], b.scene.materials[i]);
  ASSERT_EQ(a.scene.textures.size(), b.scene.textures.size());
  for (std::size_t i = 0; i < a.scene.textures.size(); ++i) {
    EXPECT_EQ(a.scene.textures[i].image, b.scene.textures[i].image);
    EXPECT_EQ(a.scene.textures[i].wrapS, b.scene.textures[i].wrapS);
    EXPECT_EQ(a.scene.textures[i].wrapT, b.scene.textures[i].wrapT);
    EXPECT_EQ(a.scene.textures[i].nearest, b.scene.textures[i].nearest);
  }
  ASSERT_EQ(a.scene.images.size(), b.scene.images.size());
  for (std::size_t i = 0; i < a.scene.images.size(); ++i) {
    EXPECT_EQ(a.scene.images[i].name, b.scene.images[i].name);
    EXPECT_EQ(a.scene.images[i].mimeType, b.scene.images[i].mimeType);
    EXPECT_EQ(a.scene.images[i].bytes, b.scene.images[i].bytes);
  }
  ASSERT_EQ(a.scene.cameras.size(), b.scene.cameras.size());
  for (std::size_t i = 0; i < a.scene.cameras.size(); ++i) expectSame(a.scene.cameras[i], b.scene.cameras[i]);
  ASSERT_EQ(a.scene.lights.size(), b.scene.lights.size());
  for (std::size_t i = 0; i < a.scene.lights.size(); ++i) expectSame(a.scene.lights[i], b.scene.lights[i]);
  EXPECT_EQ(a.transfer.resolution, b.transfer.resolution);
  EXPECT_EQ(a.transfer.terms, b.transfer.terms);
  EXPECT_EQ(a.transfer.directionCount, b.transfer.directionCount);
  EXPECT_EQ(a.transfer.directionSharpness, b.transfer.directionSharpness);
  expectSameBits(a.transfer.directions, b.transfer.directions, "directions");
  expectSameBits(a.transfer.mean, b.transfer.mean, "mean");
  expectSameBits(a.transfer.eigenfunctions, b.transfer.eigenfunctions, "eigenfunctions");
  expectSameBits(a.transfer.weightScale, b.transfer.weightScale, "weight scales");
  EXPECT_EQ(a.facts, b.facts);
}

/// A file taken apart, to be changed and put together again with all its sums right: what a faulty writer would make.
struct Parts {
  nlohmann::ordered_json json;
  std::vector<std::uint8_t> binary;

  explicit Parts(const std::vector<std::uint8_t>& bytes) {
    const GlbChunks chunks = parseGlb(bytes, "test");
    json = nlohmann::ordered_json::parse(chunks.json);
    binary.assign(chunks.binary.begin(), chunks.binary.end());
  }

  nlohmann::ordered_json& extension() { return json["extensions"]["CHIARO_radiance_transfer"]; }

  std::size_t offsetOfView(int view) const {
    return json["bufferViews"][static_cast<std::size_t>(view)]["byteOffset"].get<std::size_t>();
  }
  std::size_t offsetOfAttribute(const std::string& name) const {
    const auto accessor = json["meshes"][0]["primitives"][0]["attributes"][name].get<std::size_t>();
    return offsetOfView(json["accessors"][accessor]["bufferView"].get<int>());
  }

  void sumViews() {
    auto sums = nlohmann::ordered_json::array();
    for (const auto& view : json.at("bufferViews")) {
      const auto offset = view.at("byteOffset").get<std::size_t>(), length = view.at("byteLength").get<std::size_t>();
      if (offset > binary.size() || length > binary.size() - offset) throw std::out_of_range("a buffer view lies nowhere");
      sums.push_back(checksumOf(std::span(binary).subspan(offset, length)));
    }
    extension()["checksums"] = sums;
  }

  std::vector<std::uint8_t> bytes() {
    extension()["jsonChecksum"] = kNoChecksum;
    std::string text = json.dump();
    text.resize(aligned4(text.size()), ' ');
    const std::string sum = checksumOf(std::string_view(text));
    const auto place = text.find(jsonChecksumMember(kNoChecksum));
    text.replace(place, jsonChecksumMember(sum).size(), jsonChecksumMember(sum));
    return GltfWriter::container(text, binary);
  }

  std::string error() {
    return errorOf([&] { readBytes(bytes()); });
  }
};

TEST(Transfer, RoundTripKeepsEveryBit) {
  // 0 terms leaves out mean, eigenfunctions and weights; 1, 4, 5, 6 have 3, 0, 3, 2 columns of padding.
  for (const int terms : {0, 1, 4, 5, 6}) {
    SCOPED_TRACE(terms);
    const BakedScene baked = test::sampleBake(terms);
    const auto bytes = bytesOf(baked);
    expectSame(baked, readBytes(bytes));
    EXPECT_TRUE(bytes == bytesOf(readBytes(bytes))) << "writing what was read gives another file";
  }
}

TEST(Transfer, EigenfunctionsAreRoundedToTheNearestHalf) {
  BakedScene baked = test::tinyBake();
  baked.transfer.eigenfunctions = {1.0f / 3.0f, -1e-8f, 65504.0f, 1.0f + 1.0f / 4096.0f};
  const auto read = readBytes(bytesOf(baked)).transfer.eigenfunctions;
  // Halves around 1/3 are 2^-12 apart; 1e-8 is below half the smallest half (2^-25); 1 + 2^-12 is below the middle of 1 and 1 + 2^-10.
  EXPECT_LE(std::abs(read[0] - 1.0f / 3.0f), 1.0f / 8192.0f);
  EXPECT_EQ(read[1], 0.0f);
  EXPECT_EQ(read[2], 65504.0f);
  EXPECT_EQ(read[3], 1.0f);
}

TEST(Transfer, LargeMeshUses32BitIndices) {
  BakedScene baked = test::tinyBake();
  auto& p = baked.scene.primitives[0];
  auto& t = baked.transfer.primitives[0];
  for (const std::size_t count : {std::size_t{65535}, std::size_t{65536}}) {
    p.positions.assign(count, {0, 0, 0});
    p.normals.assign(count, {0, 0, 1});
    p.indices = {0, 1, static_cast<std::uint32_t>(count - 1)};
    t.weights.assign(4 * count, 0);
    t.visibility.assign(4 * count, 9);
    const auto bytes = bytesOf(baked);
    expectSame(baked, readBytes(bytes));
    const Parts parts(bytes);
    const auto indices = parts.json["meshes"][0]["primitives"][0]["indices"].get<std::size_t>();
    EXPECT_EQ(parts.json["accessors"][indices]["componentType"], count == 65535 ? 5123 : 5125);
  }
}

TEST(Transfer, PrimitivesAreStoredByMesh) {
  BakedScene baked = test::sampleBake();
  std::swap(baked.scene.primitives[0], baked.scene.primitives[2]);
  std::swap(baked.transfer.primitives[0], baked.transfer.primitives[2]);
  const BakedScene read = readBytes(bytesOf(baked));
  EXPECT_EQ(read.scene.primitives[0].name, "no material");
  EXPECT_EQ(read.scene.primitives[1].name, "ornament/0");
  EXPECT_EQ(read.scene.primitives[2].name, "plinth");
  EXPECT_EQ(read.transfer.primitives[2].weights, baked.transfer.primitives[0].weights);
}

TEST(Transfer, IsAnOrdinarySceneToTheSceneLoader) {
  const Folder folder;
  const BakedScene baked = test::sampleBake();
  writeBakedScene(folder / "a.glb", baked, "test");
  std::vector<std::string> warnings;
  const Scene scene = loadScene(folder / "a.glb", [&](const std::string& line) { warnings.push_back(line); });
  EXPECT_EQ(scene.vertexCount(), baked.scene.vertexCount());
  EXPECT_EQ(scene.triangleCount(), baked.scene.triangleCount());
  EXPECT_THAT(warnings, testing::IsEmpty());
}

TEST(Transfer, BytesPerVertexCountsWhatIsStored) {
  const Transfer t = test::sampleBake(6).transfer;
  // 8 padded weights of 2 bytes, 8 fractions of 1; shared: mean 64 floats, 6*64 halves, 6 scales, 8 directions of 12 bytes.
  EXPECT_DOUBLE_EQ(t.bytesPerVertex(31), 16 + 8 + (256 + 768 + 24 + 96) / 31.0);
  EXPECT_EQ(t.bytesPerVertex(0), 0.0);
}

TEST(Transfer, FactsThatAreNotFiniteReadBackAsNan) {
  BakedScene baked = test::tinyBake();
  baked.facts["error.undefined"] = std::numeric_limits<double>::infinity();
  const auto facts = readBytes(bytesOf(baked)).facts;
  EXPECT_TRUE(std::isnan(facts.at("error.undefined")));
  EXPECT_EQ(facts.at("settings.terms"), 1.0);
}

// The bytes of a file are a promise to other readers: when this changes, so must docs/format.md and, unless old files still
// mean the same, kTransferVersion.
TEST(Transfer, GoldenBytes) {
  const auto bytes = bytesOf(test::tinyBake());
  const GlbChunks chunks = parseGlb(bytes, "golden");
  // What no checksum inside the file covers comes first.
  const std::vector<std::uint8_t> head{'g', 'l', 'T', 'F', 2, 0, 0, 0};
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  const std::vector<std::uint8_t> weights{0xFF, 0x7F, 0, 0, 0, 0, 0, 0, 0x01, 0x80, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  const std::vector<std::uint8_t> visibility{255, 0, 128, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::vector<std::uint8_t> halves{0x00, 0x38, 0x00, 0xB8, 0x00, 0x34, 0x00, 0x3C};
  const Parts parts(bytes);
  const auto at = [&](std::size_t offset, const std::vector<std::uint8_t>& expected) {
    return std::equal(expected.begin(), expected.end(), parts.binary.begin() + static_cast<std::ptrdiff_t>(offset));
  };
  EXPECT_TRUE(at(parts.offsetOfAttribute("_SSDF_0"), weights));
  EXPECT_TRUE(at(parts.offsetOfAttribute("_VISIBILITY_0"), visibility));
  EXPECT_TRUE(at(parts.offsetOfView(parts.json["extensions"]["CHIARO_radiance_transfer"]["eigenfunctions"].get<int>()), halves));
  EXPECT_EQ(checksumOf(chunks.binary), "851ff4e673169fe1");
  EXPECT_EQ(checksumOf(std::span<const std::uint8_t>(bytes)), "6b1b42400a2fad3d") << std::string(chunks.json);
}

TEST(Transfer, EveryTruncatedPrefixIsRefused) {
  const Folder folder;
  const auto bytes = bytesOf(test::tinyBake());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // The loader reads the file into an allocation of exactly its size, so a sanitizer sees any step beyond it.
    const auto path = test::put(folder / "a.glb", std::span(bytes).first(length));
    const std::string error = errorOf([&] { readBakedScene(path); });
    EXPECT_THAT(error, testing::AnyOf(HasSubstr("truncated"), HasSubstr("is empty"))) << length;
    EXPECT_TRUE(test::failsCleanly([&] { loadScene(path); }));
  }
}

TEST(Transfer, TruncatedPrefixWithItsLengthCorrectedIsRefused) {
  // As above, but the header tells the shorter length: every later check has to hold.
  const auto bytes = bytesOf(test::tinyBake());
  for (std::size_t length = 12; length < bytes.size(); ++length) {
    std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    for (std::size_t i = 0; i < 4; ++i) cut[8 + i] = static_cast<std::uint8_t>(length >> (8 * i));
    EXPECT_NE(errorOf([&] { readBytes(cut); }), "") << length;
  }
}

TEST(Transfer, EveryFlippedByteIsNoticed) {
  const Folder folder;
  auto bytes = bytesOf(test::tinyBake());
  std::mt19937 random(1);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto flip = static_cast<std::uint8_t>(1 + random() % 255);
    bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
    EXPECT_NE(errorOf([&] { readBakedScene(test::put(folder / "a.glb", bytes)); }), "") << "byte " << i << " xor " << int{flip};
    bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
  }
}

// Random damage behind correct checksums: what reaches the checks of sizes, ranges and indices.
TEST(Transfer, RandomDamageBehindCorrectSumsFailsCleanly) {
  const Folder folder;
  const Parts original(bytesOf(test::sampleBake()));
  std::mt19937 random(2);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    Parts parts = original;
    std::string text = parts.json.dump();
    const int flips = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < flips; ++i) text[random() % text.size()] = "0123456789-.,{}[]\"eE"[random() % 20];
    auto damaged = nlohmann::ordered_json::parse(text, nullptr, false);
    if (damaged.is_discarded() || !damaged.is_object()) continue;
    if (!damaged.contains("extensions") || !damaged["extensions"].is_object() ||
        !damaged["extensions"].contains(kTransferExtension) || !damaged["extensions"][kTransferExtension].is_object())
      continue;
    parts.json = damaged;
    parts.binary[random() % parts.binary.size()] ^= 0x40;
    try {
      parts.sumViews();
    } catch (const std::exception&) {
      continue;  // views that lie nowhere have no sum
    }
    const auto path = test::put(folder / "a.glb", parts.bytes());
    try {
      readBakedScene(path);
    } catch (const Error&) {
      ++refused;
    }
    EXPECT_TRUE(test::failsCleanly([&] { loadScene(path); }));
  }
  EXPECT_GE(refused, 100) << "the damage hardly ever mattered: the test is too weak";
}

TEST(Transfer, ErrorsNameTheTrouble) {
  const auto good = bytesOf(test::tinyBake());
  auto bad = good;
  bad[0] = 'x';
  EXPECT_THAT(errorOf([&] { readBytes(bad); }), HasSubstr("is not a binary glTF file"));
  bad = good;
  bad[4] = 3;
  EXPECT_THAT(errorOf([&] { readBytes(bad); }), HasSubstr("binary glTF version 3"));
  bad = good;
  bad.push_back(0);
  EXPECT_THAT(errorOf([&] { readBytes(bad); }), HasSubstr("1 bytes after its end"));

  const Parts parts(good);
  for (const std::string attribute : {"_SSDF_0", "_VISIBILITY_0", "POSITION"}) {
    Parts damaged = parts;
    damaged.binary[damaged.offsetOfAttribute(attribute)] ^= 1;
    const std::string error = damaged.error();
    EXPECT_THAT(error, HasSubstr("checksum of bufferView "));
    EXPECT_THAT(error, HasSubstr(attribute + " of "));
    EXPECT_THAT(error, HasSubstr("does not match: the file is damaged, bake it again"));
  }

  Parts newer = parts;
  newer.extension()["version"] = 2;
  EXPECT_THAT(newer.error(), HasSubstr("transfer version 2, this program reads version 1: update Chiaro"));
  Parts unbaked = parts;
  unbaked.json.erase("extensions");
  const auto plain = GltfWriter::container(unbaked.json.dump(), unbaked.binary);
  EXPECT_THAT(errorOf([&] { readBytes(plain); }), HasSubstr("run chiaro-precompute"));
  const std::string text = " {\"asset\":{\"version\":\"2.0\"}}";
  EXPECT_THAT(errorOf([&] {
                readBytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
              }),
              HasSubstr("run chiaro-precompute"));
  const Folder folder;
  EXPECT_THAT(errorOf([&] { readBakedScene(test::put(folder / "a.obj", std::string("v 0 0 0\n"))); }), HasSubstr("run chiaro-precompute"));
  EXPECT_THAT(errorOf([] { readBakedScene("/nowhere/a.glb"); }), HasSubstr("/nowhere/a.glb"));
}

TEST(Transfer, FaultyWritersAreFound) {
  const Parts good(bytesOf(test::tinyBake()));
  const auto withWord = [&](const std::string& attribute, std::uint32_t word) {
    Parts parts = good;
    std::memcpy(parts.binary.data() + parts.offsetOfAttribute(attribute), &word, 4);
    parts.sumViews();
    return parts.error();
  };
  EXPECT_THAT(withWord("POSITION", 0x7FC00000),
              HasSubstr("primitive 0 of mesh 0 (triangle): POSITION is not finite at element 0"));
  EXPECT_THAT(withWord("NORMAL", 0x7F800000), HasSubstr("NORMAL is not finite"));
  EXPECT_THAT(withWord("_SSDF_0", 0x00010000), HasSubstr("weights that are not 0 behind the last term"));

  const auto withMember = [&](const std::string& name, const nlohmann::ordered_json& value) {
    Parts parts = good;
    parts.extension()[name] = value;
    return parts.error();
  };
  EXPECT_THAT(withMember("terms", 5), HasSubstr("instead of"));
  EXPECT_THAT(withMember("terms", -1), HasSubstr("\"terms\" of CHIARO_radiance_transfer is not an integer from 0"));
  EXPECT_THAT(withMember("terms", 1e300), HasSubstr("\"terms\""));
  EXPECT_THAT(withMember("terms", 18446744073709551615ull), HasSubstr("\"terms\""));
  EXPECT_THAT(withMember("resolution", 3), HasSubstr("the mean takes 16 bytes instead of 36"));
  EXPECT_THAT(withMember("directionCount", 3), HasSubstr("multiple of 4"));
  EXPECT_THAT(withMember("directionSharpness", -1), HasSubstr("directionSharpness"));
  EXPECT_THAT(withMember("mean", 99), HasSubstr("\"mean\""));
  EXPECT_THAT(withMember("parameterization", "cube"), HasSubstr("parameterization \"cube\""));
  EXPECT_THAT(withMember("facts", {{"a", "text"}}), HasSubstr("the fact \"a\" is not a number"));
  EXPECT_THAT(withMember("checksums", nlohmann::ordered_json::array()), HasSubstr("0 checksums for"));

  const auto withShared = [&](const std::string& name, std::uint32_t word) {
    Parts parts = good;
    std::memcpy(parts.binary.data() + parts.offsetOfView(parts.extension()[name].get<int>()), &word, 4);
    parts.sumViews();
    return parts.error();
  };
  EXPECT_THAT(withShared("mean", 0x7FC00000), HasSubstr("the mean is not finite at element 0"));
  EXPECT_THAT(withShared("eigenfunctions", 0x00007C00), HasSubstr("eigenfunctions is not finite at element 0"));
  EXPECT_THAT(withShared("weightScales", 0), HasSubstr("a weight scale is not positive"));
  EXPECT_THAT(withShared("directions", 0x40000000), HasSubstr("not a unit vector"));

  Parts index = good;
  const auto accessor = index.json["meshes"][0]["primitives"][0]["indices"].get<std::size_t>();
  index.binary[index.offsetOfView(index.json["accessors"][accessor]["bufferView"].get<int>())] = 3;
  index.sumViews();
  EXPECT_THAT(index.error(), HasSubstr("index 0 is 3, but there are only 3 vertices"));
  Parts missing = good;
  missing.json["meshes"][0]["primitives"][0]["attributes"].erase("_SSDF_0");
  EXPECT_THAT(missing.error(), HasSubstr("has no \"_SSDF_0\""));
  Parts type = good;
  const auto ssdf = type.json["meshes"][0]["primitives"][0]["attributes"]["_SSDF_0"].get<std::size_t>();
  type.json["accessors"][ssdf]["componentType"] = 5123;
  EXPECT_THAT(type.error(), HasSubstr("\"componentType\" of _SSDF_0"));
  Parts node = good;
  node.json["nodes"][0]["scale"] = {0, 0, 0};
  EXPECT_THAT(node.error(), HasSubstr("its nodes do not show its meshes in order"));
  Parts texture = good;
  texture.json["materials"] = {{{"normalTexture", {{"index", 4}}}}};
  EXPECT_THAT(texture.error(), HasSubstr("names texture 4, which does not exist"));
  Parts image = good;
  image.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
  EXPECT_THAT(image.error(), HasSubstr("image 0 is neither PNG nor JPEG"));
}

TEST(Transfer, WriterRefusesPartsThatDoNotFit) {
  const Folder folder;
  const auto refuses = [&](auto change) {
    BakedScene baked = test::sampleBake();
    change(baked);
    const std::string error = errorOf([&] { writeBakedScene(folder / "a.glb", baked, "test"); }, ExitCode::failed);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
    return error;
  };
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.primitives.pop_back(); }), HasSubstr("other primitives"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.primitives[1].weights.pop_back(); }), HasSubstr("number of weights"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.primitives[1].weights[7] = 1; }), HasSubstr("not 0 behind the last term"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.mean[0] = std::nanf(""); }), HasSubstr("mean is not finite"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.eigenfunctions[0] = 65520.0f; }), HasSubstr("finite as a half"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.weightScale[0] = 0.0f; }), HasSubstr("weight scale"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.transfer.directions[0] *= 2.0f; }), HasSubstr("direction is not unit"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.scene.primitives[0].normals.clear(); }), HasSubstr("normal"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.scene.primitives[0].indices[0] = 17; }), HasSubstr("index out of range"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.scene.primitives[0].positions[0].x = std::nanf(""); }), HasSubstr("position"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.scene.primitives[0].material = 2; }), HasSubstr("material"));
  EXPECT_THAT(refuses([](BakedScene& b) { b.scene.materials[0].normalTexture = 3; }), HasSubstr("texture"));
}

TEST(Transfer, UnwritableFolder) {
  EXPECT_THAT(errorOf([] { writeBakedScene("/nowhere/a.glb", test::tinyBake(), "test"); }, ExitCode::unwritableOutput),
              HasSubstr("/nowhere/a.glb"));
}

}  // namespace
}  // namespace chiaro
