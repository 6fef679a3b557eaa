#include "tests/assets/asset_test_support.h"

#include <Imath/half.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "assets/image/image.h"

namespace chiaro::test {

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "chiaro-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

Folder::~Folder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

std::filesystem::path put(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  // A new file: truncating an old one makes ext4 flush it, which costs milliseconds a time.
  std::error_code error;
  std::filesystem::remove(path, error);
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw std::runtime_error("cannot write " + path.string());
  return path;
}

std::filesystem::path put(const std::filesystem::path& path, const std::string& text) {
  return put(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::vector<std::uint8_t> get(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::uint8_t> tinyPng() {
  Image8 image;
  image.width = 3;
  image.height = 2;
  for (std::uint8_t i = 0; i < 6; ++i) {
    const auto step = static_cast<std::uint8_t>(40 * i);
    image.texels.insert(image.texels.end(), {step, static_cast<std::uint8_t>(255 - step), 7, 255});
  }
  return encodePng(image);
}

std::vector<std::uint8_t> tinyJpeg() {
  // Baseline, one grey 8x8 block cut to 1x1: quantisation by 1, a DC table of one code and an AC table of one code.
  std::vector<std::uint8_t> bytes{0xFF, 0xD8, 0xFF, 0xDB, 0x00, 0x43, 0x00};
  bytes.insert(bytes.end(), 64, 1);
  const std::vector<std::uint8_t> rest{
      0xFF, 0xC0, 0x00, 0x0B, 8, 0, 1, 0, 1, 1,    1,    0x11, 0,    0xFF, 0xC4, 0x00, 0x14, 0x00, 1, 0,    0,    0,   0, 0,
      0,    0,    0,    0,    0, 0, 0, 0, 0, 0,    0,    0xFF, 0xC4, 0x00, 0x14, 0x10, 1,    0,    0, 0,    0,    0,   0, 0,
      0,    0,    0,    0,    0, 0, 0, 0, 0, 0xFF, 0xDA, 0x00, 0x08, 1,    1,    0x00, 0,    63,   0, 0x3F, 0xFF, 0xD9};
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

namespace {

glm::vec3 anyUnit(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

Primitive anyPrimitive(std::mt19937& random, std::size_t count, bool textured) {
  std::uniform_real_distribution<float> uniform(-3.0f, 3.0f);
  Primitive p;
  for (std::size_t i = 0; i < count; ++i) {
    p.positions.emplace_back(uniform(random), uniform(random), uniform(random));
    p.normals.push_back(anyUnit(random));
    if (!textured) continue;
    p.tangents.emplace_back(anyUnit(random), i % 2 == 0 ? 1.0f : -1.0f);
    p.texcoords.emplace_back(uniform(random), uniform(random));
  }
  for (std::size_t i = 0; i < 3 * count; ++i) p.indices.push_back(static_cast<std::uint32_t>(random() % count));
  return p;
}

Transfer anyTransfer(std::mt19937& random, const Scene& scene, int resolution, int terms, int directions) {
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Transfer t;
  t.resolution = resolution;
  t.terms = terms;
  t.directionCount = directions;
  t.directionSharpness = 4.25f;
  const auto texels = static_cast<std::size_t>(resolution * resolution);
  for (int i = 0; i < directions; ++i) t.directions.push_back(anyUnit(random));
  if (terms > 0)
    for (std::size_t i = 0; i < texels; ++i) t.mean.push_back(uniform(random));
  // Halves, so that a round trip is exact.
  for (std::size_t i = 0; i < texels * static_cast<std::size_t>(terms); ++i)
    t.eigenfunctions.push_back(Imath::half(uniform(random)));
  for (int i = 0; i < terms; ++i) t.weightScale.push_back(0.5f + std::abs(uniform(random)));
  const auto padded = static_cast<std::size_t>(t.paddedTerms());
  for (const auto& p : scene.primitives) {
    PrimitiveTransfer values;
    for (std::size_t i = 0; i < p.positions.size() * padded; ++i)
      values.weights.push_back(i % padded < static_cast<std::size_t>(terms)
                                   ? static_cast<std::int16_t>(static_cast<int>(random() % 65535) - 32767)
                                   : std::int16_t{0});
    for (std::size_t i = 0; i < p.positions.size() * static_cast<std::size_t>(directions); ++i)
      values.visibility.push_back(static_cast<std::uint8_t>(random()));
    t.primitives.push_back(std::move(values));
  }
  return t;
}

/// What is stored of a row, in place of the global form.
void makeClustered(std::mt19937& random, BakedScene& baked, const std::vector<VisibilityLevel>& levels, int functions,
                   const std::vector<int>& terms, int weightBits) {
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Transfer& t = baked.transfer;
  t.terms = *std::max_element(terms.begin(), terms.end());
  t.eigenfunctions.clear();
  t.weightScale.clear();
  auto& c = t.clustered;
  c.levels = levels;
  c.weightBits = weightBits;
  // Of the SSDF, of each level, of the fractions.
  if (!levels.empty()) c.mapScales = {1.0f};
  if (!levels.empty()) c.ssdfSoftness = 0.15f;
  for (std::size_t l = 0; l < levels.size(); ++l) c.mapScales.push_back(0.5f / static_cast<float>(l + 1));
  if (!levels.empty()) c.mapScales.push_back(3.7f);
  c.functions.columnScale = columnScales(t);
  t.mean.clear();
  for (std::size_t i = 0; i < t.columns(); ++i) t.mean.push_back(0.5f + 0.5f * uniform(random));
  for (int f = 0; f < functions; ++f) {
    std::vector<float> values;
    for (std::size_t i = 0; i < t.columns(); ++i) values.push_back(uniform(random));
    const int kinds[] = {16, 12, 8, 4};
    c.functions.append(values.data(), values.size(), kinds[f % 4]);
  }
  const auto any = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) - most; };
  for (const int k : terms) {
    auto& cluster = c.clusters.emplace_back();
    cluster.terms = k;
    cluster.meanScale = 0.1f;
    for (int f = 0; f < functions; ++f) cluster.mean.push_back(static_cast<std::int16_t>(any(32767)));
    for (int i = 0; i < k * functions; ++i) cluster.components.push_back(static_cast<std::int8_t>(any(127)));
    for (int i = 0; i < k; ++i) cluster.weightScale.push_back((0.2f + 0.1f * uniform(random)) / (weightBits == 8 ? 127.0f : 32767.0f));
  }
  for (std::size_t p = 0; p < t.primitives.size(); ++p) {
    auto& values = t.primitives[p];
    values.weights.clear();
    for (std::size_t v = 0; v < baked.scene.primitives[p].positions.size(); ++v)
      values.clustered.cluster.push_back(static_cast<std::uint16_t>(random() % terms.size()));
    for (const auto cluster : values.clustered.cluster)
      for (int k = 0; k < c.clusters[cluster].terms; ++k)
        values.clustered.weights.push_back(static_cast<std::int16_t>(any(weightBits == 8 ? 127 : 32767)));
  }
  decodeFractions(t);
}

}  // namespace

BakedScene sampleBake(int terms) {
  std::mt19937 random(20240607);
  BakedScene baked;
  Scene& scene = baked.scene;
  scene.meshNames = {"ornament", "plinth \"quoted\" \\ \xC3\xA9"};
  scene.primitives = {anyPrimitive(random, 17, true), anyPrimitive(random, 5, false), anyPrimitive(random, 9, true)};
  scene.primitives[0].mesh = scene.primitives[1].mesh = 0;
  scene.primitives[2].mesh = 1;
  scene.primitives[0].material = 0;
  scene.primitives[2].material = 1;
  scene.primitives[0].name = "ornament/0";
  scene.primitives[1].name = "no material";
  scene.primitives[2].name = "plinth";
  scene.images = {{"colours", "image/png", tinyPng()}, {"", "image/jpeg", tinyJpeg()}};
  scene.textures = {{0, Wrap::clampToEdge, Wrap::mirroredRepeat, true},
                    {1, Wrap::repeat, Wrap::repeat, false},
                    {0, Wrap::repeat, Wrap::repeat, false}};
  Material brushed;
  brushed.name = "brushed";
  brushed.baseColorFactor = {0.1f, 0.2f, 0.3f, 0.4f};
  brushed.baseColorTexture = 0;
  brushed.metallicFactor = 0.7f;
  brushed.roughnessFactor = 0.3f;
  brushed.metallicRoughnessTexture = 1;
  brushed.normalTexture = 2;
  brushed.normalScale = 1.7f;
  brushed.occlusionTexture = 1;
  brushed.occlusionStrength = 0.9f;
  brushed.emissiveFactor = {12.3f, 0.1f, 5.0f};
  brushed.emissiveTexture = 0;
  brushed.alphaMode = AlphaMode::mask;
  brushed.alphaCutoff = 0.31f;
  brushed.doubleSided = true;
  brushed.anisotropyStrength = 0.8f;
  brushed.anisotropyRotation = -1.1f;
  brushed.anisotropyTexture = 2;
  brushed.baseColorTransform = {{0.1f, -0.2f}, 0.3f, {4.0f, 0.5f}};
  brushed.metallicRoughnessTransform = {{0.0f, 1.0f}, 0.0f, {1.0f, -1.0f}};
  brushed.normalTransform.rotation = -1.7f;
  brushed.occlusionTransform.offset.x = 0.7f;
  brushed.anisotropyTransform.scale.y = 3.3f;
  brushed.ior = 1.8f;
  brushed.specularFactor = 0.6f;
  brushed.specularTexture = 1;
  brushed.specularColorFactor = {1.5f, 0.25f, 0.0f};
  brushed.specularColorTexture = 0;
  brushed.specularColorTransform.rotation = 0.5f;
  brushed.clearcoatFactor = 0.75f;
  brushed.clearcoatTexture = 2;
  brushed.clearcoatTransform.offset.y = 0.3f;
  brushed.clearcoatRoughness = 0.2f;
  brushed.clearcoatRoughnessTexture = 1;
  brushed.sheenColorFactor = {0.5f, 0.25f, 0.125f};
  brushed.sheenColorTexture = 0;
  brushed.sheenColorTransform.scale.x = 2.5f;
  brushed.sheenRoughness = 0.4f;
  brushed.sheenRoughnessTexture = 2;
  brushed.reflectance = Reflectance::ashikhminShirley;
  brushed.reflectanceWidth = {{1000.0f, 20.0f}};
  brushed.reflectanceF0 = {{0.9f, 0.5f, 0.1f}};
  Material glass;
  glass.name = "glass";
  glass.alphaMode = AlphaMode::blend;
  glass.emissiveFactor = {0.25f, 0.5f, 1.0f};
  scene.materials = {brushed, glass};
  const Bounds bounds = boundsOf(scene);
  scene.cameras = {lookAt({4, 3, 9}, {0, 0.5f, 0}, 0.7f, bounds), lookAt({0, 7, 0.01f}, {0, 0, 0}, 0.7f, bounds)};
  scene.cameras[0].name = "front";
  scene.cameras[1].perspective = false;
  scene.cameras[1].verticalFov = Camera{}.verticalFov;
  scene.cameras[1].verticalExtent = 2.5f;
  Light sun, lamp, spot;
  sun.name = "sun";
  sun.direction = anyUnit(random);
  sun.color = {1.0f, 0.9f, 0.8f};
  sun.intensity = 3.5f;
  lamp.type = LightType::point;
  lamp.position = {1, 2, 3};
  lamp.range = 12.5f;
  spot.type = LightType::spot;
  spot.name = "spot";
  spot.position = {-1, 4, 0.1f};
  spot.direction = {0, -1, 0};
  spot.innerConeAngle = 0.2f;
  spot.outerConeAngle = 0.6f;
  Light wideSun = sun, ball = lamp, disk = spot, smallestDisk = spot;
  wideSun.angle = 0.1f;
  ball.type = LightType::sphere;
  ball.radius = 0.3f;
  disk.type = smallestDisk.type = LightType::disk;
  disk.radius = 2.5f;
  scene.lights = {sun, lamp, spot, wideSun, ball, disk, smallestDisk};
  baked.transfer = anyTransfer(random, scene, 8, terms, 8);
  baked.facts = {{"error.ssdf_rms_radians", 0.0123456789012345}, {"settings.terms", terms}, {"seconds.total", 1e-3}};
  return baked;
}

BakedScene tinyBake() {
  BakedScene baked;
  Scene& scene = baked.scene;
  scene.meshNames = {"triangle"};
  Primitive p;
  p.name = "triangle";
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.indices = {0, 1, 2};
  scene.primitives = {p};
  Transfer& t = baked.transfer;
  t.resolution = 2;
  t.terms = 1;
  t.directionCount = 4;
  t.directionSharpness = 2.0f;
  t.directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  t.mean = {0.5f, 1.0f, 1.5f, -0.25f};
  t.eigenfunctions = {0.5f, -0.5f, 0.25f, 1.0f};
  t.weightScale = {2.0f};
  t.primitives = {{{32767, 0, 0, 0, -32767, 0, 0, 0, 1, 0, 0, 0}, {255, 0, 128, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {}}};
  baked.facts = {{"settings.terms", 1}};
  return baked;
}

BakedScene clusteredBake(bool levels, int weightBits) {
  BakedScene baked = sampleBake();
  std::mt19937 random(20240608);
  makeClustered(random, baked, levels ? std::vector<VisibilityLevel>{{3.0f, 4}, {10.5f, 6}} : std::vector<VisibilityLevel>{}, 7, {5, 0, 2}, weightBits);
  return baked;
}

BakedScene tinyClusteredBake() {
  BakedScene baked = tinyBake();
  std::mt19937 random(20240609);
  makeClustered(random, baked, {{3.0f, 1}, {10.5f, 2}}, 4, {1, 0}, 8);
  baked.transfer.primitives[0].clustered.cluster = {0, 1, 0};
  baked.transfer.primitives[0].clustered.weights = {127, -3};
  decodeFractions(baked.transfer);
  return baked;
}

std::optional<std::filesystem::path> evaluationPack() {
  const char* data = std::getenv("CHIARO_DATA");
  const char* source = std::getenv("CHIARO_SOURCE_DIR");
  const std::filesystem::path path =
      data != nullptr ? std::filesystem::path(data) : std::filesystem::path(source != nullptr ? source : ".") / "../shared/data";
  return std::filesystem::is_directory(path / "clear") ? std::optional(path) : std::nullopt;
}

}  // namespace chiaro::test
