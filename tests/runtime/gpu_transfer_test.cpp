/// What shaders read of a baked transfer against the CPU's decoding of the same numbers: every form, cell layout and slot count.

#include "runtime/render/gpu_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "precompute/bake.h"
#include "precompute/transfer_lookup.h"
#include "runtime/gl/program.h"
#include "runtime/render/frame_block.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

/// One reading of a triangle. The corners' fourth is the level, the direction's fourth the sharpness.
struct Reading {
  glm::uvec4 corners;
  glm::vec4 barycentric;
  glm::vec4 direction;
};

/// ssdfAt, levelAt, levelShareAt, and the SSDF's share at that sharpness.
const char* const kShader = R"(
#include "shaders/stage/transfer.glsl"
struct Reading { uvec4 corners; vec4 barycentric; vec4 direction; };
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Readings { Reading readings[]; };
layout(std430, binding = 1) writeonly buffer Values { vec4 values[]; };
uniform uint count;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Reading r = readings[i];
  Transfer t = transferAt(r.corners.xyz, r.barycentric.xyz);
  vec4 value = vec4(ssdfAt(t, r.direction.xyz), 1.0, 1.0, 1.0);
#if TERM_VECTORS > 0 && LEVELS > 0
  VisibilitySource source = sourceOf(r.direction.w);
  value.y = levelAt(t, int(r.corners.w), r.direction.xyz);
  value.z = levelShareAt(t, r.direction.xyz, source);
  value.w = source.ssdf;
#endif
  values[i] = value;
}
)";

std::vector<glm::vec4> readOnGpu(const GpuTransfer& gpu, const std::vector<Reading>& readings,
                                 const gl::ShaderReader& reader = gl::readEmbeddedShader) {
  const auto program =
      gl::Program::link({{GL_COMPUTE_SHADER, gl::resolveShaderText("reading.comp", kShader, reader, gpu.defines())}});
  const gl::Buffer from(readings), to(readings.size() * sizeof(glm::vec4));
  gpu.bind();
  from.bindBase(GL_SHADER_STORAGE_BUFFER, 0);
  to.bindBase(GL_SHADER_STORAGE_BUFFER, 1);
  program.set("count", static_cast<unsigned>(readings.size()));
  program.use();
  glDispatchCompute(static_cast<GLuint>((readings.size() + 63) / 64), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  EXPECT_TRUE(testContext().debugLog().messages().empty());
  return to.read<glm::vec4>();
}

/// The rows of all vertices, decoded on the CPU.
struct Rows {
  int resolution = 0;
  std::vector<VisibilityLevel> levels;
  std::size_t columns = 0;         ///< the SSDF and the levels
  std::vector<int> cluster;        ///< by vertex
  std::vector<float> value, size;  ///< #vertices by columns; size: sum of the absolute values of what a row is the sum of

  std::size_t vertices() const { return cluster.size(); }

  void add(const float* maps, int terms, const std::vector<double>& weights, int from) {
    cluster.push_back(from);
    for (std::size_t i = 0; i < columns; ++i) {
      double sum = maps[i], absolute = std::abs(maps[i]);
      for (std::size_t k = 0; k < static_cast<std::size_t>(terms); ++k) {
        sum += weights[k] * maps[(k + 1) * columns + i];
        absolute += std::abs(weights[k] * maps[(k + 1) * columns + i]);
      }
      value.push_back(static_cast<float>(sum));
      size.push_back(static_cast<float>(absolute));
    }
  }

  explicit Rows(const Transfer& t) : resolution(t.resolution), levels(t.clustered.levels), columns(t.texels() + t.levelTexels()) {
    const auto& clusters = t.clustered.clusters;
    std::vector<float> maps;
    std::vector<std::size_t> first{0};
    if (clusters.empty()) {
      maps = t.mean;
      maps.insert(maps.end(), t.eigenfunctions.begin(), t.eigenfunctions.end());
    } else {
      maps = clusterMaps(clusters, t.clustered.functions.unpack(t.columns()), t.mean, 0, columns);
      for (const auto& c : clusters) first.push_back(first.back() + (1 + static_cast<std::size_t>(c.terms)) * columns);
    }
    for (const auto& p : t.primitives) {
      std::vector<double> weights;
      if (clusters.empty()) {
        const auto stride = static_cast<std::size_t>(t.paddedTerms());
        for (std::size_t v = 0; v * stride < p.weights.size(); ++v) {
          weights.clear();
          for (std::size_t k = 0; k < static_cast<std::size_t>(t.terms); ++k)
            weights.push_back(t.weightScale[k] * p.weights[v * stride + k] / 32767.0);
          add(maps.data(), t.terms, weights, 0);
        }
        continue;
      }
      std::size_t w = 0;
      for (const auto c : p.clustered.cluster) {
        weights.clear();
        for (const float scale : clusters[c].weightScale)
          weights.push_back(static_cast<double>(scale) * p.clustered.weights[w++]);
        add(maps.data() + first[c], clusters[c].terms, weights, c);
      }
    }
  }

  std::vector<float> interpolated(const std::vector<float>& of, const Reading& r) const {
    std::vector<float> row(columns);
    for (std::size_t i = 0; i < columns; ++i) {
      double sum = 0;
      for (int c = 0; c < 3; ++c) sum += static_cast<double>(r.barycentric[c]) * of[r.corners[c] * columns + i];
      row[i] = static_cast<float>(sum);
    }
    return row;
  }
  std::size_t clustersOf(const Reading& r) const {
    return std::set<int>{cluster[r.corners.x], cluster[r.corners.y], cluster[r.corners.z]}.size();
  }
  std::size_t firstOf(std::size_t level) const {
    auto first = static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution);
    for (std::size_t l = 0; l < level; ++l)
      first += static_cast<std::size_t>(levels[l].resolution) * static_cast<std::size_t>(levels[l].resolution);
    return first;
  }
};

/// Largest difference of the four texels that a direction is filtered from.
double contrast(const float* map, int resolution, glm::vec3 direction) {
  const auto corner = glm::ivec2(glm::floor(lobe32::octahedralEncode(direction) * static_cast<float>(resolution) - 0.5f));
  double low = 1e30, high = -1e30;
  for (int i = 0; i < 4; ++i) {
    const auto texel = lobe32::octahedralWrapTexel(corner + glm::ivec2(i % 2, i / 2), resolution);
    const double v = map[texel.y * resolution + texel.x];
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return high - low;
}

// Maps are half floats: half a unit in the last of 11 bits, of the mean and of each term.
constexpr double kHalf = 1.0 / 2048;
// A texture unit takes its place between two texels in steps of 1/256 (Vulkan asks for 1/16, GPUs have this), at worst one step off along
// each axis. Mesa's software renderer filters in float: without this term its worst reading is .88 of the bound.
double filterError() { return testContext().renderer().find("llvmpipe") != std::string::npos ? 0.0 : 2.0 / 256; }
// What float arithmetic on the way to a texel adds, in radians and shares: 1e-7 of a map of 64 texels of contrast 1.
constexpr double kFloat = 1e-5;

/// NaN stays.
void raise(double& worst, double value) { worst = value <= worst || std::isnan(worst) ? worst : value; }

struct Worst {
  double error = 0, ofBound = 0;
  void take(double difference, double bound) {
    raise(error, std::abs(difference));
    raise(ofBound, std::abs(difference) / bound);
  }
  void report(const char* name) const { std::printf("  %-14s worst %.2e, %.2f of its bound\n", name, error, ofBound); }
};

struct Comparison {
  Worst ssdf, level, share;
  std::array<int, 4> bySlots{};  ///< readings whose corners are in 1, 2 and 3 clusters
};

Comparison compare(const Transfer& transfer, const std::vector<Reading>& readings, const std::vector<glm::vec4>& got) {
  const Rows rows(transfer);
  Comparison result;
  auto& [ssdf, level, share, bySlots] = result;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto& r = readings[i];
    ++bySlots[rows.clustersOf(r)];
    const auto row = rows.interpolated(rows.value, r), size = rows.interpolated(rows.size, r);
    const glm::vec3 d(r.direction);
    const auto bound = [&](std::size_t first, int resolution) {
      return kHalf * static_cast<double>(sampleOctahedral(size.data() + first, resolution, d)) +
             filterError() * contrast(row.data() + first, resolution, d) + kFloat;
    };
    const auto stored = static_cast<double>(sampleOctahedral(row.data(), rows.resolution, d)), softness = static_cast<double>(transfer.clustered.ssdfSoftness);
    double ssdfBound = bound(0, rows.resolution);
    // The steepest that a stored distance is expanded within its bound: d/dt of softness artanh(t / softness).
    if (softness > 0.0) ssdfBound /= 1.0 - std::pow(std::min((std::abs(stored) + ssdfBound) / softness, 0.99505475), 2);
    ssdf.take(static_cast<double>(got[i].x) - lobe64::ssdfExpanded(stored, softness), ssdfBound);
    if (rows.levels.empty()) continue;
    const auto l = static_cast<std::size_t>(r.corners.w);
    const auto first = rows.firstOf(l);
    const double expected =
        std::clamp(static_cast<double>(sampleOctahedral(row.data() + first, rows.levels[l].resolution, d)), 0.0, 1.0);
    level.take(static_cast<double>(got[i].y) - expected, bound(first, rows.levels[l].resolution));

    // As shade.glsl puts the two together. A lobe's visible share rises by sqrt(sharpness / 2 pi) a radian at most.
    const auto sharpness = static_cast<double>(r.direction.w);
    const double seen =
        glm::mix(static_cast<double>(got[i].z), lobe64::ssdfVisibleFraction(static_cast<double>(got[i].x), sharpness),
                 static_cast<double>(got[i].w));
    double most = 0;
    for (std::size_t k = 0; k < rows.levels.size(); ++k) most = std::max(most, bound(rows.firstOf(k), rows.levels[k].resolution));
    share.take(seen - visibleShare(row.data(), rows.resolution, rows.levels, transfer.clustered.ssdfSoftness, d, sharpness),
               most + static_cast<double>(got[i].w) * ssdfBound * std::sqrt(sharpness / (2 * std::numbers::pi)));
  }
  return result;
}

/// Anywhere, and where maps have poles, seams, folds and borders, on them and just beside.
std::vector<glm::vec3> directions(std::mt19937& random, int resolution) {
  std::normal_distribution<float> gauss;
  std::vector<glm::vec3> list;
  for (int i = 0; i < 64; ++i) list.push_back(glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random))));
  for (const float s : {-1.0f, 1.0f}) list.insert(list.end(), {glm::vec3(s, 0, 0), glm::vec3(0, s, 0), glm::vec3(0, 0, s)});
  for (const float zero : {0.0f, -0.0f, 1e-7f, -1e-7f, 1e-3f, -1e-3f})
    for (const float a : {-0.9f, -0.3f, 0.02f, 0.6f}) {
      const float b = std::sqrt(1.0f - a * a);
      for (const float s : {-1.0f, 1.0f})
        list.insert(list.end(), {glm::vec3(zero, a, s * b), glm::vec3(a, zero, s * b), glm::vec3(a, s * b, zero)});
    }
  // Texel centres and corners of the border.
  for (int i = 0; i < resolution; i += std::max(1, resolution / 8))
    for (const float half : {0.0f, 0.5f})
      for (const float edge : {half / static_cast<float>(resolution), 1.0f - half / static_cast<float>(resolution)}) {
        const float along = (static_cast<float>(i) + half) / static_cast<float>(resolution);
        list.push_back(lobe32::octahedralDecode({along, edge}));
        list.push_back(lobe32::octahedralDecode({edge, along}));
      }
  return list;
}

std::vector<glm::uvec3> trianglesOf(const Scene& scene) {
  std::vector<glm::uvec3> list;
  std::uint32_t first = 0;
  for (const auto& p : scene.primitives) {
    for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3)
      list.emplace_back(first + p.indices[i], first + p.indices[i + 1], first + p.indices[i + 2]);
    first += static_cast<std::uint32_t>(p.positions.size());
  }
  return list;
}

/// The scene's triangles and as many triples of any vertices, at corners, on edges and inside, each with some of the directions.
std::vector<Reading> readingsOf(const BakedScene& baked, std::uint32_t seed, std::size_t most) {
  std::mt19937 random(seed);
  auto triangles = trianglesOf(baked.scene);
  const auto vertices = static_cast<std::uint32_t>(baked.scene.vertexCount());
  for (std::size_t i = triangles.size(); i > 0; --i)
    triangles.emplace_back(random() % vertices, random() % vertices, random() % vertices);
  const std::array<glm::vec3, 5> places{
      glm::vec3(1, 0, 0), {0, 0, 1}, {0.25f, 0.75f, 0}, {0.2f, 0.5f, 0.3f}, {0.4f, 0.01f, 0.59f}};
  const std::array<float, 8> sharpnesses{0.0f, 2.0f, 7.0f, 36.75f, 100.0f, 150.0f, 190.0f, 2000.0f};
  const auto& levels = baked.transfer.clustered.levels;
  const auto dirs = directions(random, baked.transfer.resolution);
  std::vector<Reading> list;
  for (std::size_t i = 0; i < most; ++i) {
    const auto level = levels.empty() ? 0u : static_cast<unsigned>(random() % levels.size());
    list.push_back({glm::uvec4(triangles[i % triangles.size()], level), glm::vec4(places[random() % places.size()], 0),
                    glm::vec4(dirs[random() % dirs.size()], sharpnesses[random() % sharpnesses.size()])});
  }
  return list;
}

/// Returns Comparison::bySlots.
std::array<int, 4> expectSameOnGpu(const BakedScene& baked, std::uint32_t seed, std::size_t count = 6000) {
  const GpuTransfer gpu(baked);
  EXPECT_TRUE(gpu.occludes());
  const auto readings = readingsOf(baked, seed, count);
  const auto c = compare(baked.transfer, readings, readOnGpu(gpu, readings));
  std::printf("%zu readings, corners in 1, 2, 3 clusters: %d, %d, %d\n", readings.size(), c.bySlots[1], c.bySlots[2],
              c.bySlots[3]);
  c.ssdf.report("ssdfAt");
  c.level.report("levelAt");
  c.share.report("visible share");
  EXPECT_LE(c.ssdf.ofBound, 1.0);
  EXPECT_LE(c.level.ofBound, 1.0);
  EXPECT_LE(c.share.ofBound, 1.0);
  return c.bySlots;
}

BakedScene baked(Compression compression, int weightBits, int clusters = 7) {
  BakeReport report;
  const BakeSettings settings{.compression = compression,
                              .resolution = 32,
                              .samplingResolution = 32,
                              .terms = 10,
                              .clusters = clusters,
                              .functions = 32,
                              .weightBits = weightBits,
                              .directionCount = 16};
  return bake(boxesOnFloor(8), settings, report);
}

const BakedScene& jointScene() {
  static const BakedScene scene = baked(Compression::joint, 8);
  return scene;
}

TEST(GpuTransfer, JointWith8BitWeights) {
  const auto bySlots = expectSameOnGpu(jointScene(), 1);
  for (int slots = 1; slots <= 3; ++slots) EXPECT_GE(bySlots[static_cast<std::size_t>(slots)], 100) << "too few to be a test";
  const Rows rows(jointScene().transfer);
  std::map<std::size_t, int> meshTriangles;
  for (const auto& t : trianglesOf(jointScene().scene)) ++meshTriangles[rows.clustersOf({glm::uvec4(t, 0), {}, {}})];
  EXPECT_GE(meshTriangles[1], 1);
  EXPECT_GE(meshTriangles[2] + meshTriangles[3], 1) << "the scene's own clusters must meet";
}

TEST(GpuTransfer, JointWith16BitWeights) { expectSameOnGpu(baked(Compression::joint, 16), 2); }

TEST(GpuTransfer, ClusteredWithoutLevels) { expectSameOnGpu(baked(Compression::clustered, 8), 3); }

TEST(GpuTransfer, OneCluster) {
  const auto bySlots = expectSameOnGpu(baked(Compression::joint, 8, 1), 4);
  EXPECT_EQ(bySlots[2] + bySlots[3], 0);
}

TEST(GpuTransfer, GlobalForm) { expectSameOnGpu(baked(Compression::pca, 16), 5); }

/// Clusters of 0 to 16 terms and random maps, two vertices in each. Functions are half floats and steps of 12 bits.
BakedScene syntheticScene(std::size_t clusters, int weightBits) {
  std::mt19937 random(9);
  const auto uniform = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  BakedScene baked;
  auto& t = baked.transfer;
  auto& c = t.clustered;
  t.resolution = 8;
  t.terms = 16;
  t.directionCount = 4;
  t.directionSharpness = 32;
  t.directions.assign(4, glm::vec3(0, 1, 0));
  c.levels = {{3.0f, 4}, {12.0f, 8}, {48.0f, 6}};  // the widest in the middle
  c.weightBits = weightBits;
  c.mapScales = {1.0f, 0.4f, 2.5f, 0.7f, 1.5f};
  c.functions.columnScale = columnScales(t);
  const auto columns = t.columns();
  for (std::size_t i = 0; i < columns; ++i) t.mean.push_back(uniform(0.2f, 0.8f));
  constexpr std::size_t kFunctions = 12;
  for (std::size_t f = 0; f < kFunctions; ++f) {
    std::vector<float> function(columns);
    for (float& v : function) v = uniform(-1, 1);
    c.functions.append(function.data(), columns, f % 3 == 0 ? 16 : 12);
  }
  const int steps = weightBits == 8 ? 127 : 32767;
  t.primitives.resize(2);
  baked.scene = sceneWith({Primitive{}, Primitive{}});
  for (std::size_t i = 0; i < clusters; ++i) {
    auto& cluster = c.clusters.emplace_back();
    cluster.terms = i % 5 == 2 ? 0 : 13 + static_cast<int>(i % 4);
    cluster.meanScale = 0.2f;
    for (std::size_t f = 0; f < kFunctions; ++f) cluster.mean.push_back(static_cast<std::int16_t>(uniform(-32767, 32767)));
    for (std::size_t f = 0; f < kFunctions * static_cast<std::size_t>(cluster.terms); ++f)
      cluster.components.push_back(static_cast<std::int8_t>(uniform(-127, 127)));
    for (int k = 0; k < cluster.terms; ++k) cluster.weightScale.push_back(uniform(0.01f, 0.1f) / static_cast<float>(steps));
  }
  for (std::size_t p = 0; p < 2; ++p) {
    auto& vertices = t.primitives[p].clustered;
    auto& primitive = baked.scene.primitives[p];
    for (std::size_t v = 0; v < clusters; ++v) {
      const auto cluster = static_cast<std::uint16_t>(p == 0 ? v : clusters - 1 - v);
      vertices.cluster.push_back(cluster);
      // The largest weights there are, too.
      for (int k = 0; k < c.clusters[cluster].terms; ++k) {
        const int w = std::array{static_cast<int>(uniform(-1, 1) * static_cast<float>(steps)), steps,
                                 -steps}[random() % 5 < 3 ? 0 : 1 + random() % 2];
        vertices.weights.push_back(static_cast<std::int16_t>(w));
      }
      primitive.positions.emplace_back(0);
      primitive.normals.emplace_back(0, 1, 0);
    }
    for (std::uint32_t v = 0; v + 2 < clusters; v += 3) primitive.indices.insert(primitive.indices.end(), {v, v + 1, v + 2});
    t.primitives[p].visibility.assign(4 * clusters, 255);
  }
  return baked;
}

TEST(GpuTransfer, MoreCellsThanATextureArrayHasLayers) {
  GLint layers = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  // 3.2 cells a cluster: two columns, and three.
  for (const double times : {1.1, 2.1}) {
    const auto clusters = static_cast<std::size_t>(times * layers / 3.2);
    std::printf("%zu clusters, %d layers\n", clusters, layers);
    const auto scene = syntheticScene(clusters, 8);
    std::size_t cells = 0;
    for (const auto& c : scene.transfer.clustered.clusters) cells += static_cast<std::size_t>(c.terms + 3) / 4;
    ASSERT_GT(cells, static_cast<std::size_t>(times * layers * 0.9));
    ASSERT_GT(cells, static_cast<std::size_t>(layers));
    expectSameOnGpu(scene, 6, 3000);
  }
}

TEST(GpuTransfer, AClusterWithoutTerms) {
  for (const int weightBits : {8, 16}) {
    const auto scene = syntheticScene(20, weightBits);
    const auto& clusters = scene.transfer.clustered.clusters;
    ASSERT_TRUE(std::any_of(clusters.begin(), clusters.end(), [](const auto& c) { return c.terms == 0; }));
    expectSameOnGpu(scene, 7);
  }
}

// All of them: the means alone make the rows.
TEST(GpuTransfer, NoClusterHasTerms) {
  auto scene = syntheticScene(6, 8);
  scene.transfer.terms = 0;
  for (auto& c : scene.transfer.clustered.clusters) {
    c.terms = 0;
    c.components.clear();
    c.weightScale.clear();
  }
  for (auto& p : scene.transfer.primitives) p.clustered.weights.clear();
  expectSameOnGpu(scene, 8);
}

// A test of the test: what these comparisons must find.
TEST(GpuTransfer, FindsAPlantedFault) {
  const auto& right = jointScene();
  const auto readings = readingsOf(right, 10, 3000);
  const auto worstOf = [&](const BakedScene& wrong, const gl::ShaderReader& reader = gl::readEmbeddedShader) {
    return compare(right.transfer, readings, readOnGpu(GpuTransfer(wrong), readings, reader)).ssdf.ofBound;
  };
  EXPECT_LE(worstOf(right), 1.0);
  auto wrong = right;
  for (auto& w : wrong.transfer.primitives[0].clustered.weights) w = static_cast<std::int16_t>(-w);
  EXPECT_GT(worstOf(wrong), 5.0) << "weights of the wrong sign";
  wrong = right;
  std::swap(wrong.transfer.clustered.clusters[0].mean, wrong.transfer.clustered.clusters[1].mean);
  EXPECT_GT(worstOf(wrong), 5.0) << "two clusters exchanged";
  const auto shifted = [](const std::string& name) {
    auto text = gl::readEmbeddedShader(name);
    if (name != "shaders/stage/transfer.glsl") return text;
    const std::string border = "* float(resolution) + 1.0;";
    const auto at = text->find(border);
    EXPECT_NE(at, std::string::npos) << "the line to break is gone";
    return std::optional(text->replace(at, border.size(), "* float(resolution) + 0.9;"));
  };
  EXPECT_GT(worstOf(right, shifted), 3.0) << "a tenth of a texel off";
}

// Two triangles that share an edge read the same along it, whatever clusters their other corners are in: no seam.
TEST(GpuTransfer, NoSeamsBetweenClusters) {
  const auto& scene = jointScene();
  const Rows rows(scene.transfer);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> third;
  for (const auto& t : trianglesOf(scene.scene))
    for (int c = 0; c < 3; ++c) third[std::minmax(t[c], t[(c + 1) % 3])].push_back(t[(c + 2) % 3]);
  std::mt19937 random(11);
  const auto dirs = directions(random, scene.transfer.resolution);
  std::vector<Reading> readings;  // in pairs
  std::size_t edges = 0;
  for (const auto& [edge, corners] : third) {
    const auto [a, b] = edge;
    if (corners.size() < 2 ||
        std::set<int>{rows.cluster[a], rows.cluster[b], rows.cluster[corners[0]], rows.cluster[corners[1]]}.size() < 2)
      continue;
    ++edges;
    for (const float s : {0.1f, 0.5f, 0.83f})
      for (int i = 0; i < 12; ++i) {
        const glm::vec4 direction(dirs[random() % dirs.size()], 50.0f);
        const auto level = static_cast<unsigned>(random() % 4);
        readings.push_back({{a, b, corners[0], level}, {s, 1 - s, 0, 0}, direction});
        readings.push_back({{corners[1], b, a, level}, {0, 1 - s, s, 0}, direction});
      }
  }
  ASSERT_GE(edges, 20u);
  const auto got = readOnGpu(GpuTransfer(scene), readings);
  double jump = 0, most = 0;
  for (std::size_t i = 0; i < got.size(); i += 2)
    for (int k = 0; k < 4; ++k) {
      const double d = std::abs(static_cast<double>(got[i][k]) - static_cast<double>(got[i + 1][k]));
      raise(jump, d);
      most = std::max(most, std::abs(static_cast<double>(got[i][k])));
    }
  std::printf("%zu edges where clusters meet: largest jump %.1e of values up to %.2f\n", edges, jump, most);
  EXPECT_LE(jump, 2e-6);  // the order in which a dozen floats are added
}

/// What light_visibility.comp writes.
TEST(GpuTransfer, LightsAtVertices) {
  for (const auto& scene : {jointScene(), baked(Compression::clustered, 16), baked(Compression::pca, 16)}) {
    const GpuTransfer gpu(scene);
    std::mt19937 random(12);
    const auto dirs = directions(random, scene.transfer.resolution);
    const std::vector<float> sharpnesses{0.5f, 3.0f, 20.0f, 128.625f, 150.0f, 190.0f, 5000.0f};
    FrameBlock frame;
    const auto vertices = gpu.vertexCount();
    std::vector<Reading> readings;
    for (std::size_t l = 0; l < 24; ++l)
      frame.sgLights[l].axisSharpness = glm::vec4(dirs[(l * 37) % dirs.size()], sharpnesses[l % sharpnesses.size()]);
    frame.counts.x = 24;
    for (std::size_t v = 0; v < vertices; ++v)
      for (std::size_t l = 0; l < 24; ++l)
        // Corners two and three weigh nothing, whatever they are.
        readings.push_back({{v, (v + 1) % vertices, (v * 7) % vertices, 0}, {1, 0, 0, 0}, frame.sgLights[l].axisSharpness});
    const auto expected = readOnGpu(gpu, readings);

    const auto program = gl::Program::loadCompute("shaders/stage/light_visibility.comp", gpu.defines());
    const gl::Buffer to(readings.size() * sizeof(std::uint32_t));
    const gl::Buffer block(std::span<const FrameBlock>(&frame, 1));
    block.bindBase(GL_UNIFORM_BUFFER, 0);
    to.bindBase(GL_SHADER_STORAGE_BUFFER, 5);
    gpu.bind();
    program.set("rowGroups", 1);  // more than one row of work groups
    program.set("vertexCount", static_cast<unsigned>(vertices));
    program.use();
    const auto groups = static_cast<GLuint>((vertices + 63) / 64);
    ASSERT_GE(groups, 2u);
    glDispatchCompute(1, groups, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const auto got = to.read<std::uint32_t>();
    double distance = 0, share = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      const auto seen = glm::unpackHalf2x16(got[i]);
      const auto difference = [&](float a, float b) {
        return static_cast<double>(std::abs(a - b) / std::max(std::abs(b), 1e-2f));
      };
      raise(distance, difference(seen.x, expected[i].x));
      if (expected[i].w < 1.0f && !scene.transfer.clustered.levels.empty())
        raise(share, difference(seen.y, expected[i].z));
      else
        EXPECT_EQ(seen.y, 1.0f);
    }
    std::printf("%zu lights at vertices: distance %.1e, share %.1e of the value\n", got.size(), distance, share);
    // Stored as halves, which packHalf2x16 may also cut: a whole unit.
    EXPECT_LE(distance, 2.0 * kHalf);
    EXPECT_LE(share, 2.0 * kHalf);
  }
}

}  // namespace
}  // namespace chiaro
