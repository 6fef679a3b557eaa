// The baked file: what goes in comes out, and nothing that was damaged gets in.
#include "assets/transfer/coded_lists.h"
#include "assets/transfer/row_decoder.h"
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
  EXPECT_EQ(a.ior, b.ior);
  EXPECT_EQ(a.specularFactor, b.specularFactor);
  EXPECT_EQ(a.specularTexture, b.specularTexture);
  EXPECT_EQ(a.specularTransform, b.specularTransform);
  EXPECT_EQ(a.specularColorFactor, b.specularColorFactor);
  EXPECT_EQ(a.specularColorTexture, b.specularColorTexture);
  EXPECT_EQ(a.specularColorTransform, b.specularColorTransform);
  EXPECT_EQ(a.clearcoatFactor, b.clearcoatFactor);
  EXPECT_EQ(a.clearcoatTexture, b.clearcoatTexture);
  EXPECT_EQ(a.clearcoatTransform, b.clearcoatTransform);
  EXPECT_EQ(a.clearcoatRoughness, b.clearcoatRoughness);
  EXPECT_EQ(a.clearcoatRoughnessTexture, b.clearcoatRoughnessTexture);
  EXPECT_EQ(a.clearcoatRoughnessTransform, b.clearcoatRoughnessTransform);
  EXPECT_EQ(a.reflectance, b.reflectance);
  EXPECT_EQ(a.reflectanceWidth, b.reflectanceWidth);
  EXPECT_EQ(a.reflectanceF0, b.reflectanceF0);
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
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.angle, b.angle);
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
  const auto &c = a.transfer.clustered, &d = b.transfer.clustered;
  EXPECT_EQ(c.levels, d.levels);
  EXPECT_EQ(c.weightBits, d.weightBits);
  expectSameBits(c.mapScales, d.mapScales, "map scales");
  EXPECT_EQ(c.ssdfSoftness, d.ssdfSoftness);
  expectSameBits(c.functions.columnScale, d.functions.columnScale, "column scales");
  expectSameBits(c.functions.bits, d.functions.bits, "function bits");
  expectSameBits(c.functions.scale, d.functions.scale, "function scales");
  expectSameBits(c.functions.data, d.functions.data, "functions");
  ASSERT_EQ(c.clusters.size(), d.clusters.size());
  for (std::size_t i = 0; i < c.clusters.size(); ++i) {
    EXPECT_EQ(c.clusters[i].terms, d.clusters[i].terms);
    EXPECT_EQ(c.clusters[i].meanScale, d.clusters[i].meanScale);
    expectSameBits(c.clusters[i].mean, d.clusters[i].mean, "cluster mean");
    expectSameBits(c.clusters[i].components, d.clusters[i].components, "components");
    expectSameBits(c.clusters[i].weightScale, d.clusters[i].weightScale, "weight scales");
  }
  for (std::size_t i = 0; i < a.transfer.primitives.size(); ++i) {
    expectSameBits(a.transfer.primitives[i].clustered.cluster, b.transfer.primitives[i].clustered.cluster, "clusters");
    expectSameBits(a.transfer.primitives[i].clustered.weights, b.transfer.primitives[i].clustered.weights, "clustered weights");
  }
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

  std::span<const std::uint8_t> view(int index) const {
    return std::span(binary).subspan(offsetOfView(index), json["bufferViews"][static_cast<std::size_t>(index)]["byteLength"].get<std::size_t>());
  }

  /// Views behind it move.
  void replaceView(int index, std::span<const std::uint8_t> bytes) {
    std::vector<std::uint8_t> all;
    auto& views = json["bufferViews"];
    for (std::size_t i = 0; i < views.size(); ++i) {
      const auto own = static_cast<int>(i) == index ? bytes : view(static_cast<int>(i));
      all.resize(aligned4(all.size()));
      views[i]["byteOffset"] = all.size();
      views[i]["byteLength"] = own.size();
      all.insert(all.end(), own.begin(), own.end());
    }
    all.resize(aligned4(all.size()));
    json["buffers"][0]["byteLength"] = all.size();
    binary = all;
    sumViews();
  }

  void replaceLists(const CodedLists& lists) {
    const auto clustered = extension()["clustered"];
    const auto replace = [&](const nlohmann::ordered_json& owner, const char* name, const std::vector<std::uint8_t>& list) {
      if (!list.empty()) replaceView(owner[name].get<int>(), list);
    };
    replace(clustered, "functions", lists.functions);
    replace(clustered, "clusterMeans", lists.means);
    replace(clustered, "components", lists.components);
    for (std::size_t p = 0; p < lists.clusters.size(); ++p) {
      replace(clustered["primitives"][p], "clusters", lists.clusters[p]);
      replace(clustered["primitives"][p], "weights", lists.weights[p]);
    }
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

TEST(Transfer, RoundTripOfClustersKeepsEveryBit) {
  for (const bool levels : {false, true})
    for (const int weightBits : {8, 16}) {
      SCOPED_TRACE(weightBits);
      const BakedScene baked = test::clusteredBake(levels, weightBits);
      const auto bytes = bytesOf(baked);
      expectSame(baked, readBytes(bytes));
      EXPECT_TRUE(bytes == bytesOf(readBytes(bytes))) << "writing what was read gives another file";
    }
  expectSame(test::tinyClusteredBake(), readBytes(bytesOf(test::tinyClusteredBake())));
  // The functions' only kind, with a scale for the one map there is.
  BakedScene plain = test::clusteredBake(false);
  auto& c = plain.transfer.clustered;
  const auto values = c.functions.unpack(64);
  c.mapScales = {0.3f};
  c.functions = {};
  c.functions.columnScale = columnScales(plain.transfer);
  for (std::size_t f = 0; f < 7; ++f) c.functions.append(values.data() + f * 64, 64, 12);
  expectSame(plain, readBytes(bytesOf(plain)));
}

TEST(Transfer, ListsThatWereCodedAlreadyAreUsed) {
  BakedScene baked = test::clusteredBake(true);
  const auto best = bytesOf(baked);
  baked.coded = codedLists(baked.transfer);
  EXPECT_TRUE(bytesOf(baked) == best);
  const Parts parts(bytesOf(baked));
  const auto view = parts.view(Parts(parts).extension()["clustered"]["functions"].get<int>());
  EXPECT_TRUE(std::equal(view.begin(), view.end(), baked.coded->functions.begin(), baked.coded->functions.end()));
  const BakedScene read = readBytes(bytesOf(baked));
  ASSERT_TRUE(read.coded.has_value());
  EXPECT_TRUE(holds(*read.coded, read.transfer));
  EXPECT_EQ(read.coded->bytes(), baked.coded->bytes());
  expectSame(baked, read);
}

TEST(Transfer, ClustersWithoutFunctionsNeedNothingMore) {
  BakedScene baked = test::tinyBake();
  Transfer& t = baked.transfer;
  t.terms = 0;
  t.eigenfunctions.clear();
  t.weightScale.clear();
  t.primitives[0].weights.clear();
  t.clustered.clusters.resize(1);
  t.primitives[0].clustered.cluster = {0, 0, 0};
  expectSame(baked, readBytes(bytesOf(baked)));
  t.clustered.levels = {{4.0f, 2}};
  t.mean.assign(t.columns(), 1.0f);
  decodeFractions(t);
  for (const auto v : t.primitives[0].visibility) EXPECT_EQ(v, 255);
  expectSame(baked, readBytes(bytesOf(baked)));
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

TEST(Transfer, BytesPerVertexOfClustersCountsWhatIsStored) {
  for (const bool levels : {false, true})
    for (const int weightBits : {8, 16}) {
      const BakedScene baked = test::clusteredBake(levels, weightBits);
      const Transfer& t = baked.transfer;
      const auto lists = codedLists(t);
      // Mean of floats, 8 directions, bits and scales of 7 functions, terms and mean scale of 3 clusters, scales of 7 terms; 4 map scales, or the
      // fractions of each vertex.
      const double rest = 4 * (levels ? 124 : 64) + 96 + 7 * (1 + 4) + 3 * (2 + 4) + 7 * 4 + (levels ? 4 * 4 : 31 * 8);
      const double all = static_cast<double>(lists.bytes()) + rest;
      EXPECT_DOUBLE_EQ(t.bytesPerVertex(31), all / 31);
      EXPECT_DOUBLE_EQ(t.bytesPerVertex(31, &lists), all / 31);
      CodedLists longer = lists;
      longer.weights[1].resize(longer.weights[1].size() + 31);
      EXPECT_DOUBLE_EQ(t.bytesPerVertex(31, &longer), all / 31 + 1) << "what is passed counts";
      // The file says the same: all that its extension and its vertices' fractions point to, map scales aside.
      Parts parts(bytesOf(baked));
      std::size_t stored = levels ? 0 : 31 * 8;
      const auto count = [&](const nlohmann::ordered_json& owner, std::initializer_list<const char*> names) {
        for (const auto* name : names) stored += parts.view(owner[name].get<int>()).size();
      };
      count(parts.extension(), {"mean", "directions"});
      count(parts.extension()["clustered"], {"functionBits", "functionScales", "functions", "clusterTerms", "clusterMeanScales", "clusterMeans",
                                              "weightScales", "components"});
      for (const auto& p : parts.extension()["clustered"]["primitives"]) count(p, {"clusters", "weights"});
      EXPECT_DOUBLE_EQ(static_cast<double>(stored) + (levels ? 16 : 0), all);
    }
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

/// Small enough for every byte: both forms.
std::vector<BakedScene> tinyBakes() { return {test::tinyBake(), test::tinyClusteredBake()}; }

TEST(Transfer, EveryTruncatedPrefixIsRefused) {
  const Folder folder;
  for (const auto& baked : tinyBakes()) {
    const auto bytes = bytesOf(baked);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      // The loader reads the file into an allocation of exactly its size, so a sanitizer sees any step beyond it.
      const auto path = test::put(folder / "a.glb", std::span(bytes).first(length));
      const std::string error = errorOf([&] { readBakedScene(path); });
      EXPECT_THAT(error, testing::AnyOf(HasSubstr("truncated"), HasSubstr("is empty"))) << length;
      EXPECT_TRUE(test::failsCleanly([&] { loadScene(path); }));
    }
  }
}

TEST(Transfer, TruncatedPrefixWithItsLengthCorrectedIsRefused) {
  // As above, but the header tells the shorter length: every later check has to hold.
  const Folder folder;
  for (const auto& baked : tinyBakes()) {
    const auto bytes = bytesOf(baked);
    for (std::size_t length = 12; length < bytes.size(); ++length) {
      std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
      for (std::size_t i = 0; i < 4; ++i) cut[8 + i] = static_cast<std::uint8_t>(length >> (8 * i));
      EXPECT_NE(errorOf([&] { readBakedScene(test::put(folder / "a.glb", cut)); }), "") << length;
    }
  }
}

TEST(Transfer, EveryFlippedByteIsNoticed) {
  const Folder folder;
  std::mt19937 random(1);
  for (const auto& baked : tinyBakes()) {
    auto bytes = bytesOf(baked);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const auto flip = static_cast<std::uint8_t>(1 + random() % 255);
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
      EXPECT_NE(errorOf([&] { readBakedScene(test::put(folder / "a.glb", bytes)); }), "") << "byte " << i << " xor " << int{flip};
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
    }
  }
}

// Random damage behind correct checksums: what reaches the checks of sizes, ranges and indices.
void damageAtRandom(const BakedScene& baked, std::uint32_t seed) {
  const Folder folder;
  const Parts original(bytesOf(baked));
  std::mt19937 random(seed);
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

TEST(Transfer, RandomDamageBehindCorrectSumsFailsCleanly) {
  damageAtRandom(test::sampleBake(), 2);
  damageAtRandom(test::clusteredBake(true), 3);
  damageAtRandom(test::clusteredBake(false, 16), 4);
}

/// Lists with numbers that no writer would store, behind streams that are all right.
CodedLists wrongLists(Transfer t, std::mt19937& random) {
  auto& functions = t.clustered.functions.data;
  auto& clusters = t.clustered.clusters;
  auto& vertices = t.primitives[0].clustered;
  const auto any = [&](int lowest) { return random() % 4 == 0 ? lowest : static_cast<int>(random() % 200) - 100; };
  for (auto i = random() % 3; i > 0; --i) functions[random() % functions.size()] = static_cast<std::uint8_t>(random());
  if (random() % 2 == 0) clusters[random() % 2].mean[random() % 4] = static_cast<std::int16_t>(any(-32768));
  if (random() % 2 == 0) clusters[0].components[random() % 4] = static_cast<std::int8_t>(any(-128));
  if (random() % 2 == 0) vertices.weights[random() % 2] = static_cast<std::int16_t>(any(-128));
  auto lists = codedLists(t, 1);
  if (random() % 2 == 0) {
    std::vector<std::uint8_t> owners{0, 1, 0, 0, 0, 0};
    owners[random() % 6] = static_cast<std::uint8_t>(random() % 3);
    lists.clusters[0] = packXz(owners);
  }
  return lists;
}

// The transfer's own part is a small share of a file: here nothing else is damaged.
TEST(Transfer, DamageInTheClusteredPartFailsCleanly) {
  const Folder folder;
  const BakedScene right = test::tinyClusteredBake();
  const Parts original(bytesOf(right));
  std::mt19937 random(5);
  int refused = 0, read = 0;
  for (int round = 0; round < 4000; ++round) {
    Parts parts = original;
    if (round % 4 > 0) parts.replaceLists(wrongLists(right.transfer, random));
    auto& clustered = parts.extension()["clustered"];
    std::string text = clustered.dump();
    for (auto i = random() % 2; i > 0; --i) text[random() % text.size()] = "0123456789-.,{}[]\"eE"[random() % 20];
    auto damaged = nlohmann::ordered_json::parse(text, nullptr, false);
    if (damaged.is_discarded()) continue;
    clustered = damaged;
    if (random() % 4 == 0) parts.extension()["terms"] = random() % 6;
    if (round % 4 == 0)
      for (auto i = random() % 3; i > 0; --i) parts.binary[random() % parts.binary.size()] = static_cast<std::uint8_t>(random());
    parts.sumViews();
    const auto path = test::put(folder / "a.glb", parts.bytes());
    try {
      const auto baked = readBakedScene(path);
      ++read;
      // What is read can be written: the writer checks all that a program relies on.
      EXPECT_NO_THROW(writeBakedScene(folder / "b.glb", baked, "test"));
    } catch (const Error&) {
      ++refused;
    }
  }
  std::printf("%d refused, %d read\n", refused, read);
  EXPECT_GE(refused, 500);
  EXPECT_GE(read, 500);
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

TEST(Transfer, FaultyWritersOfClustersAreFound) {
  const Parts good(bytesOf(test::tinyClusteredBake()));
  const auto withMember = [&](const std::string& name, const nlohmann::ordered_json& value) {
    Parts parts = good;
    parts.extension()["clustered"][name] = value;
    return parts.error();
  };
  using nlohmann::ordered_json;
  EXPECT_THAT(withMember("levels", 3), HasSubstr("\"levels\""));
  EXPECT_THAT(withMember("levels", ordered_json::array({{{"sharpness", 3}, {"resolution", 0}}})), HasSubstr("\"resolution\" of a level"));
  EXPECT_THAT(withMember("levels", ordered_json::array({{{"sharpness", 3}, {"resolution", 1}}, {{"sharpness", 3}, {"resolution", 2}}})),
              HasSubstr("do not get sharper"));
  EXPECT_THAT(withMember("levels", ordered_json::array({{{"sharpness", -1}, {"resolution", 1}}})), HasSubstr("do not get sharper"));
  EXPECT_THAT(withMember("levels", ordered_json::array({{{"sharpness", 3}, {"resolution", 4096}}})), HasSubstr("the mean takes"));
  auto uneven = ordered_json::array();
  for (const double sharpness : {3.0, 10.5, 21.0}) uneven.push_back({{"sharpness", sharpness}, {"resolution", 1}});
  EXPECT_THAT(withMember("levels", uneven), HasSubstr("not spaced evenly"));
  auto many = ordered_json::array();
  for (int i = 1; i <= 17; ++i) many.push_back({{"sharpness", i}, {"resolution", 1}});
  EXPECT_THAT(withMember("levels", many), HasSubstr("more than 16 levels"));
  EXPECT_THAT(withMember("functionCount", 5000), HasSubstr("\"functionCount\""));
  EXPECT_THAT(withMember("functionCount", -1), HasSubstr("\"functionCount\""));
  EXPECT_THAT(withMember("functionCount", 2), HasSubstr("instead of"));
  EXPECT_THAT(withMember("functionCount", 0), HasSubstr("without functions"));
  EXPECT_THAT(withMember("clusterCount", 0), HasSubstr("\"clusterCount\""));
  EXPECT_THAT(withMember("clusterCount", 65536), HasSubstr("\"clusterCount\""));
  EXPECT_THAT(withMember("clusterCount", 3), HasSubstr("instead of"));
  EXPECT_THAT(withMember("weightBits", 12), HasSubstr("neither 8 nor 16"));
  EXPECT_THAT(withMember("weightBits", 16), HasSubstr("the list of weights of"));
  for (const auto& wrong : {ordered_json(0), ordered_json(-1), ordered_json("soft"), ordered_json(1e300)})
    EXPECT_THAT(withMember("ssdfSoftness", wrong), HasSubstr("\"ssdfSoftness\" is not a number above 0"));
  EXPECT_THAT(withMember("mapScales", 1), HasSubstr("\"mapScales\" of \"clustered\" is not a list"));
  EXPECT_THAT(withMember("mapScales", ordered_json::array()), HasSubstr("has 0 map scales for 4 maps"));
  EXPECT_THAT(withMember("mapScales", {1, 1, 1, 1, 1}), HasSubstr("has 5 map scales for 4 maps"));
  for (const auto& wrong : {ordered_json(0), ordered_json(-1), ordered_json("1"), ordered_json(nullptr), ordered_json(1e300), ordered_json(1e-300)})
    EXPECT_THAT(withMember("mapScales", {1, 1, wrong, 1}), HasSubstr("a map scale is not positive and finite")) << wrong;
  EXPECT_THAT(withMember("mapScales", {1, 1, 3e38, 1}), HasSubstr("the list of functions is not finite"));
  EXPECT_THAT(withMember("functions", 99), HasSubstr("\"functions\""));
  EXPECT_THAT(withMember("primitives", ordered_json::array()), HasSubstr("other primitives"));
  auto two = good.json["extensions"]["CHIARO_radiance_transfer"]["clustered"]["primitives"];
  two.push_back(two[0]);
  EXPECT_THAT(withMember("primitives", two), HasSubstr("other primitives"));
  Parts none = good;
  none.extension()["clustered"] = 1;
  EXPECT_THAT(none.error(), HasSubstr("\"levels\""));
  Parts flat = good;
  flat.extension()["resolution"] = 0;
  EXPECT_THAT(flat.error(), HasSubstr("\"resolution\""));
  Parts few = good;
  few.extension()["terms"] = 0;
  EXPECT_THAT(few.error(), HasSubstr("more terms than"));

  const auto withByte = [&](const ordered_json& view, std::size_t offset, std::vector<std::uint8_t> bytes) {
    Parts parts = good;
    std::copy(bytes.begin(), bytes.end(), parts.binary.begin() + static_cast<std::ptrdiff_t>(parts.offsetOfView(view.get<int>()) + offset));
    parts.sumViews();
    return parts.error();
  };
  const auto clustered = Parts(good).extension()["clustered"];
  const std::vector<std::uint8_t> nan{0, 0, 0xC0, 0x7F}, negative{0, 0, 0x80, 0xBF};
  EXPECT_THAT(withByte(clustered["functionBits"], 0, {5}), HasSubstr("5 bits a value"));
  EXPECT_THAT(withByte(clustered["functionScales"], 4, nan), HasSubstr("function scales is not finite at element 1"));
  EXPECT_THAT(withByte(clustered["functionScales"], 4, negative), HasSubstr("a function scale is not positive"));
  EXPECT_THAT(withByte(clustered["clusterTerms"], 0, {0, 1}), HasSubstr("more terms than"));
  EXPECT_THAT(withByte(clustered["clusterTerms"], 2, {1, 0}), HasSubstr("instead of"));
  EXPECT_THAT(withByte(clustered["clusterMeanScales"], 0, nan), HasSubstr("mean scales is not finite"));
  EXPECT_THAT(withByte(clustered["clusterMeanScales"], 0, negative), HasSubstr("a mean scale is negative"));
  EXPECT_THAT(withByte(clustered["weightScales"], 0, nan), HasSubstr("weight scales is not finite"));
  EXPECT_THAT(withByte(clustered["weightScales"], 0, {0, 0, 0, 0}), HasSubstr("a weight scale is not positive"));
  EXPECT_THAT(withByte(Parts(good).extension()["mean"], 0, nan), HasSubstr("the mean is not finite at element 0"));
}

TEST(Transfer, NumbersOutOfRangeInsideStreamsAreFound) {
  const auto with = [](auto change, int weightBits = 8) {
    const BakedScene baked = test::clusteredBake(true, weightBits);
    Transfer wrong = baked.transfer;
    change(wrong);
    Parts parts(bytesOf(baked));
    parts.replaceLists(codedLists(wrong));
    return parts.error();
  };
  using T = Transfer&;
  // 124 columns; functions of 16, 12, 8 and 4 bits begin at 0, 248, 496 and 620.
  const auto withFunctions = [&](std::size_t at, std::initializer_list<std::uint8_t> bytes, std::size_t apart = 1) {
    return with([&](T t) {
      std::size_t i = at;
      for (const auto byte : bytes) t.clustered.functions.data[i] = byte, i += apart;
    });
  };
  EXPECT_THAT(withFunctions(2, {0x00, 0x7C}), HasSubstr("the list of functions is not finite at element 1")) << "a half";
  EXPECT_THAT(withFunctions(248 + 5, {0x00, 0x08}, 124), HasSubstr("a function has a value out of range")) << "2048 steps";
  EXPECT_THAT(withFunctions(248 + 123, {0x00, 0xF8}, 124), HasSubstr("a function has a value out of range")) << "-2048 steps";
  EXPECT_THAT(withFunctions(496 + 123, {0x80}), HasSubstr("a function has a value out of range"));
  EXPECT_THAT(withFunctions(620 + 1, {0x08}), HasSubstr("a function has a value out of range")) << "-8, in a low nibble";
  EXPECT_THAT(withFunctions(620 + 8 * 9 - 3, {0x80}), HasSubstr("a function has a value out of range")) << "in a high one, the last but a few";
  EXPECT_THAT(with([](T t) { t.clustered.clusters[2].mean[6] = -32768; }), HasSubstr("mean is out of range"));
  EXPECT_THAT(with([](T t) { t.clustered.clusters[2].components[13] = -128; }), HasSubstr("a component is out of range"));
  EXPECT_THAT(with([](T t) { t.primitives[0].clustered.weights[1] = -128; }), HasSubstr("a weight out of range"));
  EXPECT_THAT(with([](T t) { t.primitives[0].clustered.weights[1] = -32768; }, 16), HasSubstr("a weight out of range"));

  const auto withClusters = [](std::vector<std::uint8_t> bytes) {
    Parts parts(bytesOf(test::tinyClusteredBake()));
    parts.replaceView(parts.extension()["clustered"]["primitives"][0]["clusters"].get<int>(), packXz(bytes));
    return parts.error();
  };
  EXPECT_THAT(withClusters({0, 2, 0, 0, 0, 0}), HasSubstr("names cluster 2 of 2"));
  EXPECT_THAT(withClusters({0, 1, 0, 0, 0, 1}), HasSubstr("names cluster 256 of 2"));
  EXPECT_THAT(withClusters({0, 0, 0, 0, 0, 0}), HasSubstr("the list of weights of primitive 0 (of mesh 0) does not unpack to 3 bytes"));
}

TEST(Transfer, StreamsThatDoNotUnpackAreFound) {
  const BakedScene baked = test::clusteredBake(true);
  const Parts good(bytesOf(baked));
  const auto lists = codedLists(baked.transfer);
  const auto clustered = Parts(good).extension()["clustered"];
  const auto& of = clustered["primitives"][1];
  struct Case {
    int view;
    std::vector<std::uint8_t> stream;
    std::string line;
  };
  const auto count = std::to_string(baked.transfer.primitives[1].clustered.weights.size());
  const std::vector<Case> cases{
      {clustered["functions"].get<int>(), lists.functions, "the list of functions does not unpack to 1312 bytes"},
      {clustered["clusterMeans"].get<int>(), lists.means, "the list of cluster means does not unpack to 42 bytes"},
      {clustered["components"].get<int>(), lists.components, "the list of components does not unpack to 49 bytes"},
      {of["clusters"].get<int>(), lists.clusters[1], "the list of clusters of primitive 1 (of mesh 0) does not unpack to 10 bytes"},
      {of["weights"].get<int>(), lists.weights[1], "the list of weights of primitive 1 (of mesh 0) does not unpack to " + count + " bytes"},
  };
  for (const auto& c : cases) {
    const auto with = [&](const std::vector<std::uint8_t>& stream) {
      Parts parts = good;
      parts.replaceView(c.view, stream);
      return parts.error();
    };
    const auto view = good.view(c.view);
    ASSERT_TRUE(std::equal(view.begin(), view.end(), c.stream.begin(), c.stream.end())) << "the file holds just this";
    const auto line = HasSubstr(c.line + ": the file is damaged, bake it again");
    auto wrong = c.stream;
    wrong[wrong.size() / 2] ^= 1;
    EXPECT_THAT(with(wrong), line);
    wrong = c.stream;
    wrong.pop_back();
    EXPECT_THAT(with(wrong), line);
    wrong = c.stream;
    wrong.insert(wrong.end(), 4, 0);
    EXPECT_THAT(with(wrong), line) << "padding";
    wrong = c.stream;
    wrong.insert(wrong.end(), c.stream.begin(), c.stream.end());
    EXPECT_THAT(with(wrong), line) << "two streams";
    EXPECT_THAT(with({1, 2, 3, 4}), line);
    EXPECT_THAT(with(packXz({})), line);
    EXPECT_THAT(with(packXz(std::vector<std::uint8_t>(1000000))), line) << "longer";
  }
}

TEST(Transfer, WriterRefusesClustersThatDoNotFit) {
  const Folder folder;
  const auto refuses = [&](auto change) {
    BakedScene baked = test::clusteredBake(true);
    change(baked, baked.transfer.clustered);
    const std::string error = errorOf([&] { writeBakedScene(folder / "a.glb", baked, "test"); }, ExitCode::failed);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
    return error;
  };
  using B = BakedScene&;
  using C = ClusteredTransfer&;
  EXPECT_THAT(refuses([](B b, C) { b.transfer.resolution = 0; }), HasSubstr("resolution"));
  EXPECT_THAT(refuses([](B, C c) { c.levels[1].sharpness = 3.0f; }), HasSubstr("sharper"));
  EXPECT_THAT(refuses([](B, C c) { c.levels.push_back({21.0f, 1}); }), HasSubstr("not spaced evenly"));
  EXPECT_THAT(refuses([](B, C c) { c.levels[0].resolution = 0; }), HasSubstr("level is out of range"));
  EXPECT_THAT(refuses([](B, C c) {
                c.levels.clear();
                for (int i = 1; i <= 17; ++i) c.levels.push_back({static_cast<float>(i), 1});
              }),
              HasSubstr("too many levels"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.mean.pop_back(); }), HasSubstr("mean has the wrong size"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.mean[3] = std::nanf(""); }), HasSubstr("mean is not finite"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.directions[0] *= 2.0f; }), HasSubstr("direction is not unit"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.directionSharpness = std::nanf(""); }), HasSubstr("direction sharpness"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.weightScale.push_back(1.0f); }), HasSubstr("beside clusters"));
  EXPECT_THAT(refuses([](B, C c) { c.weightBits = 12; }), HasSubstr("8 nor 16"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.bits[2] = 5; }), HasSubstr("number of bits"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.scale[2] = 0.0f; }), HasSubstr("function scale"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.scale.pop_back(); }), HasSubstr("function scales"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.data.pop_back(); }), HasSubstr("functions have the wrong size"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.data[1] = 0x7C; }), HasSubstr("function is not finite")) << "a half";
  EXPECT_THAT(refuses([](B b, C) { b.transfer.terms = 4; }), HasSubstr("too many terms"));
  EXPECT_THAT(refuses([](B, C c) { c.clusters[0].components.pop_back(); }), HasSubstr("cluster has the wrong size"));
  EXPECT_THAT(refuses([](B, C c) { c.clusters[0].weightScale[1] = 0.0f; }), HasSubstr("weight scale"));
  EXPECT_THAT(refuses([](B, C c) { c.clusters[0].meanScale = -1.0f; }), HasSubstr("mean"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.primitives[1].clustered.cluster.pop_back(); }), HasSubstr("one cluster a vertex"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.primitives[1].clustered.cluster[0] = 3; }), HasSubstr("cluster that does not exist"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.primitives[0].clustered.weights.pop_back(); }), HasSubstr("number of weights"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.primitives[0].clustered.weights[0] = 128; }), HasSubstr("weight out of range"));
  EXPECT_THAT(refuses([](B, C c) { c.ssdfSoftness = -1.0f; }), HasSubstr("softness"));
  EXPECT_THAT(refuses([](B, C c) { c.mapScales.pop_back(); }), HasSubstr("map scales have the wrong size"));
  EXPECT_THAT(refuses([](B, C c) { c.mapScales[1] = 0.0f; }), HasSubstr("map scale is not positive"));
  EXPECT_THAT(refuses([](B, C c) { c.mapScales.clear(); }), HasSubstr("column scales are not those of the maps"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.columnScale[70] = 1.5f; }), HasSubstr("column scales are not those of the maps"));
  EXPECT_THAT(refuses([](B, C c) { c.functions.data[248 + 124] = 0x10; }), HasSubstr("function has a value out of range")) << "12 bits";
  EXPECT_THAT(refuses([](B, C c) { c.clusters[0].mean[6] = -32768; }), HasSubstr("mean is out of range"));
  EXPECT_THAT(refuses([](B, C c) { c.clusters[2].components[3] = -128; }), HasSubstr("component is out of range"));
  EXPECT_THAT(refuses([](B b, C c) {
                b.coded = codedLists(b.transfer);
                c.clusters[0].mean[6] ^= 1;
              }),
              HasSubstr("coded lists are not those of its transfer"));
  EXPECT_THAT(refuses([](B b, C) { b.transfer.primitives[0].weights.push_back(0); }), HasSubstr("number of weights"));
  EXPECT_THAT(refuses([](B, C c) {
                c.functions = {};
                c.mapScales.clear();
                for (auto& cluster : c.clusters) cluster.mean.clear(), cluster.components.clear();
              }),
              HasSubstr("without functions"));
}

std::vector<float> unpacked(const std::vector<float>& values, int bits) {
  PackedFunctions packed;
  packed.append(values.data(), values.size(), bits);
  EXPECT_EQ(packed.count(), 1u);
  EXPECT_EQ(packed.data.size(), PackedFunctions::bytesOf(bits, values.size()));
  EXPECT_TRUE(packed.scale[0] > 0.0f && std::isfinite(packed.scale[0]));
  return packed.unpack(values.size());
}

/// Half a step of each value: of 11 bits of a half (2^-25 where it is denormal), of 2047 or 127 to the largest of all, of 7 to what the block's byte holds,
/// which is rounded up to one of 255. A millionth for the arithmetic.
float halfStep(const std::vector<float>& values, std::size_t i, int bits) {
  const auto largest = [&](std::size_t first, std::size_t end) {
    float most = 0.0f;
    for (std::size_t j = first; j < std::min(end, values.size()); ++j) most = std::max(most, std::abs(values[j]));
    return most;
  };
  if (bits == 16) return std::max(std::abs(values[i]) * 0x1p-11f, 0x1p-25f) * 1.000001f;
  const float most = std::max(largest(0, values.size()), 1e-30f);
  if (bits != 4) return most / (bits == 12 ? 2047.0f : 127.0f) * 0.50001f;
  return (largest(i / 16 * 16, i / 16 * 16 + 16) + most / 255.0f) / 7.0f * 0.500001f;
}

TEST(PackedFunctions, AreWithinHalfAStep) {
  std::mt19937 random(6);
  std::normal_distribution<float> normal;
  for (const int bits : {16, 12, 8, 4})
    for (const std::size_t columns : {1, 2, 15, 16, 17, 31, 33, 100})
      for (const float scale : {1e-40f, 1e-20f, 1e-3f, 1.0f, 300.0f}) {
        std::vector<float> values;
        // Blocks of very different size, and some all zero.
        for (std::size_t i = 0; i < columns; ++i) values.push_back(i / 16 % 3 == 2 ? 0.0f : scale * normal(random) * (i / 16 % 3 == 1 ? 1e-3f : 1.0f));
        const auto back = unpacked(values, bits);
        ASSERT_EQ(back.size(), columns);
        for (std::size_t i = 0; i < columns; ++i)
          EXPECT_LE(std::abs(back[i] - values[i]), halfStep(values, i, bits)) << bits << " bits, " << i << " of " << columns << ", scale " << scale;
      }
}

TEST(PackedFunctions, Extremes) {
  for (const int bits : {16, 12, 8, 4}) {
    for (const std::size_t columns : {1, 16, 19}) {
      for (const float v : unpacked(std::vector<float>(columns, 0.0f), bits)) EXPECT_EQ(v, 0.0f);
      for (const float one : {1.0f, -1.0f, 0.37f})
        for (const float v : unpacked(std::vector<float>(columns, one), bits)) EXPECT_LE(std::abs(v - one), 2e-4f) << "the largest value is nearly exact";
    }
    EXPECT_TRUE(unpacked({}, bits).empty());
  }
  for (const int bits : {12, 8}) {
    const auto peak = unpacked({1e30f, -1e30f, 5e29f}, bits);
    EXPECT_LE(std::abs(peak[1] / -1e30f - 1.0f), 1e-6f);
  }
}

TEST(PackedFunctions, StepsOfTwelveBits) {
  PackedFunctions packed;
  packed.columnScale = {1.0f, 0.5f, 4.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
  // A step is 1, a half, 4 and 1.
  const std::vector<float> values{3.4f, 3.4f, -5.0f, -128.0f, -129.0f, 127.0f, 128.0f, 2047.4f, -1e30f};
  packed.appendSteps(values.data(), values.size(), 2047.0f);
  // -129 = 127 - 256, 128 = -128 + 256, 2047 = -1 + 2048: as 8 bits and a sign say.
  const std::vector<std::uint8_t> bytes{3, 7, 255, 128, 127, 127, 128, 255, 1, 0, 0, 0, 0, 255, 0, 1, 8, 248};
  EXPECT_EQ(packed.data, bytes);
  EXPECT_EQ(packed.bits, std::vector<std::uint8_t>{12});
  EXPECT_TRUE(packed.inRange(9));
  const std::vector<float> expected{3.0f, 3.5f, -4.0f, -128.0f, -129.0f, 127.0f, 128.0f, 2047.0f, -2047.0f};
  const auto back = packed.unpack(9);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(std::abs(back[i] - expected[i]), 1e-6f * std::abs(expected[i])) << i;

  // Without a scale of its own: the largest in steps of its column.
  PackedFunctions own;
  own.columnScale = {1.0f, 0.1f, 10.0f};
  const std::vector<float> three{1.0f, -0.3f, 20.0f};
  own.append(three.data(), 3, 12);
  EXPECT_LE(std::abs(own.scale[0] - 3.0f), 1e-6f);
  const auto read = own.unpack(3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(std::abs(read[i] - three[i]), 3.0f * own.columnScale[i] / 2047.0f * 0.501f) << i;

  // Every q there is comes back, and no other is in range.
  for (int q = -32768; q <= 32767; ++q) {
    own.data = {static_cast<std::uint8_t>(q & 255), 0, 0, static_cast<std::uint8_t>((q + 128) / 256 - ((q + 128) % 256 < 0 ? 1 : 0)), 0, 0};
    ASSERT_EQ(own.inRange(3), std::abs(q) <= 2047) << q;
    if (std::abs(q) <= 2047) {
      ASSERT_EQ(std::lrint(own.unpack(3)[0] / own.scale[0] * 2047.0f), q);
    }
  }
}

TEST(PackedFunctions, OfSeveralKindsLieBehindOneAnother) {
  PackedFunctions packed;
  std::vector<std::vector<float>> functions;
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  for (const int bits : {4, 16, 12, 8, 4, 4, 12, 8, 16}) {
    functions.emplace_back();
    for (int i = 0; i < 21; ++i) functions.back().push_back(normal(random));
    packed.append(functions.back().data(), 21, bits);
  }
  const auto all = packed.unpack(21);
  ASSERT_EQ(all.size(), 9u * 21u);
  for (std::size_t f = 0; f < 9; ++f)
    for (std::size_t i = 0; i < 21; ++i) EXPECT_LE(std::abs(all[f * 21 + i] - functions[f][i]), halfStep(functions[f], i, packed.bits[f]));
}

TEST(ColumnScales, AreTheirMaps) {
  const Transfer t = test::clusteredBake(true).transfer;
  const auto& s = t.clustered.mapScales;
  std::vector<float> expected(64, s[0]);
  expected.insert(expected.end(), 16, s[1]);
  expected.insert(expected.end(), 36, s[2]);
  expected.insert(expected.end(), 8, s[3]);
  EXPECT_EQ(columnScales(t), expected);
  Transfer plain = test::clusteredBake(false).transfer;
  EXPECT_TRUE(columnScales(plain).empty());
  plain.clustered.mapScales = {2.0f};
  EXPECT_EQ(columnScales(plain), std::vector<float>(64, 2.0f));
}

TEST(RowDecoder, IsTheSumOfTheClustersMaps) {
  const Transfer t = test::clusteredBake(true).transfer;
  const auto columns = t.columns();
  const auto maps = clusterMaps(t.clustered.clusters, t.clustered.functions.unpack(columns), t.mean, 0, columns);
  const RowDecoder decoder(t);
  std::size_t vertex = 0;
  for (const auto& p : t.primitives) {
    const auto first = p.clustered.firstWeights(t.clustered.clusters);
    for (std::size_t v = 0; v < p.clustered.cluster.size(); ++v, ++vertex) {
      std::vector<float> row(columns, 1.0f);
      decoder.add(vertex, 0.5f, row.data());
      const auto c = p.clustered.cluster[v];
      std::size_t map = 0;
      for (std::size_t i = 0; i < c; ++i) map += 1 + static_cast<std::size_t>(t.clustered.clusters[i].terms);
      for (std::size_t j = 0; j < columns; ++j) {
        double sum = static_cast<double>(maps[map * columns + j]);
        for (std::size_t k = 0; k < t.clustered.clusters[c].weightScale.size(); ++k)
          sum += static_cast<double>(t.clustered.clusters[c].weightScale[k]) * p.clustered.weights[first[v] + k] *
                 static_cast<double>(maps[(map + 1 + k) * columns + j]);
        ASSERT_LE(std::abs(static_cast<double>(row[j]) - (1.0 + 0.5 * sum)), 1e-5) << "single precision sums of 5 by 7";
      }
    }
  }
  EXPECT_EQ(vertex, 31u);
}

TEST(ClusterMaps, AreSumsOfFunctions) {
  const Transfer t = test::clusteredBake(true).transfer;
  const auto columns = t.columns(), count = t.clustered.functions.count();
  EXPECT_EQ(columns, 64u + 16u + 36u + 8u);
  const auto functions = t.clustered.functions.unpack(columns);
  const auto all = clusterMaps(t.clustered.clusters, functions, t.mean, 0, columns);
  ASSERT_EQ(all.size(), (3u + 7u) * columns);
  std::size_t map = 0;
  for (const auto& cluster : t.clustered.clusters)
    for (int k = -1; k < cluster.terms; ++k, ++map)
      for (std::size_t j = 0; j < columns; ++j) {
        double sum = k < 0 ? static_cast<double>(t.mean[j]) : 0.0;
        for (std::size_t d = 0; d < count; ++d)
          sum += static_cast<double>(functions[d * columns + j]) *
                 (k < 0 ? static_cast<double>(cluster.meanScale) * cluster.mean[d] / 32767.0
                        : cluster.components[static_cast<std::size_t>(k) * count + d] / 127.0);
        ASSERT_LE(std::abs(static_cast<double>(all[map * columns + j]) - sum), 1e-5) << "single precision sums of " << count;
      }
  // Any part of the columns is that part of the whole.
  for (const auto& [begin, end] : {std::pair<std::size_t, std::size_t>{0, 1}, {5, 124}, {123, 124}, {60, 60}}) {
    const auto part = clusterMaps(t.clustered.clusters, functions, t.mean, begin, end);
    ASSERT_EQ(part.size(), 10 * (end - begin));
    for (std::size_t m = 0; m < 10; ++m)
      for (std::size_t j = begin; j < end; ++j) ASSERT_LE(std::abs(part[m * (end - begin) + j - begin] - all[m * columns + j]), 1e-6f);
  }
}

TEST(ClusterMaps, LongRowsAreTheSame) {
  // Longer than a strip, so that the strips must meet.
  std::vector<float> functions, mean;
  for (int i = 0; i < 300; ++i) mean.push_back(static_cast<float>(i));
  for (int i = 0; i < 5 * 300; ++i) functions.push_back(static_cast<float>(i % 300));
  const TransferCluster cluster{.terms = 1, .meanScale = 0.0f, .mean = {0, 0, 0, 0, 0}, .components = {127, 127, 127, 127, 127}, .weightScale = {1}};
  const auto maps = clusterMaps({cluster, cluster}, functions, mean, 7, 300);
  for (std::size_t m = 0; m < 4; ++m)
    for (std::size_t j = 0; j < 293; ++j) ASSERT_EQ(maps[m * 293 + j], (m % 2 == 0 ? 1.0f : 5.0f) * static_cast<float>(7 + j));
}

TEST(ClusteredVertices, FirstWeights) {
  std::vector<TransferCluster> clusters(3);
  clusters[0].terms = 3;
  clusters[2].terms = 5;
  EXPECT_EQ((ClusteredVertices{.cluster = {2, 1, 0, 0}, .weights = {}}.firstWeights(clusters)), (std::vector<std::size_t>{0, 5, 5, 8, 11}));
  EXPECT_EQ(ClusteredVertices{}.firstWeights(clusters), std::vector<std::size_t>{0});
}

TEST(DecodedFractions, AreTheRowsLastColumns) {
  const Transfer t = test::clusteredBake(true).transfer;
  const auto columns = t.columns();
  const auto functions = t.clustered.functions.unpack(columns);
  std::size_t clamped = 0, between = 0;
  for (const auto& p : t.primitives) {
    const auto first = p.clustered.firstWeights(t.clustered.clusters);
    for (std::size_t v = 0; v < p.clustered.cluster.size(); ++v) {
      const auto& cluster = t.clustered.clusters[p.clustered.cluster[v]];
      for (std::size_t j = 0; j < 8; ++j) {
        double row = static_cast<double>(t.mean[columns - 8 + j]);
        for (std::size_t d = 0; d < 7; ++d) {
          double factor = static_cast<double>(cluster.meanScale) * cluster.mean[d] / 32767.0;
          for (std::size_t k = 0; k < cluster.weightScale.size(); ++k)
            factor += static_cast<double>(cluster.weightScale[k]) * p.clustered.weights[first[v] + k] * cluster.components[7 * k + d] / 127.0;
          row += factor * static_cast<double>(functions[d * columns + columns - 8 + j]);
        }
        (row <= 0.0 || row >= 1.0 ? clamped : between) += 1;
        // Rounded to the nearest byte; 1e-3 of one for what single precision may turn over.
        EXPECT_LE(std::abs(p.visibility[v * 8 + j] - 255.0 * std::clamp(row, 0.0, 1.0)), 0.501);
      }
    }
  }
  EXPECT_GT(clamped, 5u);
  EXPECT_GT(between, 50u);
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
