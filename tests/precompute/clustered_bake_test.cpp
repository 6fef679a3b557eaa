// The clustered forms of a bake on small scenes: how good they are, that nothing but the input decides their bytes, and extremes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/bake.h"
#include "precompute/ssdf/ssdf.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

constexpr int kSharpness[]{3, 10, 30, 100, 300, 1000, 3000};

constexpr BakeSettings kJoint{.compression = Compression::joint, .resolution = 16, .samplingResolution = 64, .terms = 24, .directionCount = 16};
constexpr BakeSettings kClustered{.compression = Compression::clustered, .resolution = 16, .samplingResolution = 64, .terms = 24, .directionCount = 16};

struct Baked {
  BakedScene scene;
  BakeReport report;
  std::map<std::string, double> error;
  double operator[](const std::string& name) const { return error.at(name); }
  double fraction(int sharpness, bool uncompressed = false) const {
    return error.at((uncompressed ? "visible_fraction_uncompressed_mean_abs_" : "visible_fraction_mean_abs_") + std::to_string(sharpness));
  }
};

Baked baked(const Scene& scene, const BakeSettings& settings) {
  Baked result;
  result.scene = bake(scene, settings, result.report);
  result.error = {result.report.error.begin(), result.report.error.end()};
  return result;
}

std::vector<std::uint8_t> bytesOf(const BakedScene& scene) {
  writeBakedScene("clustered.glb", scene, "bake test");
  return readFile("clustered.glb");
}

void expectFinite(const Baked& b) {
  for (const auto& [name, value] : b.error) EXPECT_TRUE(std::isfinite(value) && value >= 0.0) << name << " " << value;
  for (const float m : b.scene.transfer.mean) ASSERT_TRUE(std::isfinite(m));
  for (const float f : b.scene.transfer.clustered.functions.unpack(b.scene.transfer.columns())) ASSERT_TRUE(std::isfinite(f));
  EXPECT_FALSE(b.scene.transfer.clustered.empty());
  bytesOf(b.scene);  // the writer checks the rest
  readBakedScene("clustered.glb");
}


/// The weights of every vertex in its transfer's functions: #functions each, in the order of the primitives.
std::vector<std::vector<double>> coordinatesOf(const Transfer& t) {
  std::vector<std::vector<double>> all;
  for (const auto& primitive : t.primitives) {
    const auto& own = primitive.clustered;
    const auto first = own.firstWeights(t.clustered.clusters);
    for (std::size_t v = 0; v < own.cluster.size(); ++v) {
      const auto& cluster = t.clustered.clusters[own.cluster[v]];
      std::vector<double> row;
      for (std::size_t d = 0; d < cluster.mean.size(); ++d) {
        double value = static_cast<double>(cluster.meanScale) * cluster.mean[d] / 32767.0;
        for (std::size_t k = 0; k < cluster.weightScale.size(); ++k)
          value += static_cast<double>(cluster.weightScale[k]) * own.weights[first[v] + k] * cluster.components[k * cluster.mean.size() + d] / 127.0;
        row.push_back(value);
      }
      all.push_back(std::move(row));
    }
  }
  return all;
}

/// Mean square that rounding to steps adds to the SSDF: of the functions, each value uniformly off by at most half its step.
double functionRounding(const Transfer& t) {
  const auto coordinates = coordinatesOf(t);
  const auto& f = t.clustered.functions;
  double sum = 0.0;
  const std::uint8_t* data = f.data.data();
  for (std::size_t d = 0; d < f.count(); ++d) {
    double square = 0.0;  // of the steps, mean over the texels
    if (f.bits[d] == 8) square = std::pow(static_cast<double>(f.scale[d]) / 127.0, 2);
    if (f.bits[d] == 4)
      for (std::size_t b = 0; b < t.texels() / 16; ++b)
        square += 16.0 / static_cast<double>(t.texels()) * std::pow(static_cast<double>(f.scale[d]) * data[9 * b] / (255.0 * 7.0), 2);
    data += PackedFunctions::bytesOf(f.bits[d], t.columns());
    for (const auto& row : coordinates) sum += row[d] * row[d] * square / 12.0 / static_cast<double>(coordinates.size());
  }
  return sum;
}

/// The same of the weights; functions and components are orthonormal by solid angle but for their own rounding.
double weightRounding(const Transfer& t) {
  double sum = 0.0, vertices = 0.0;
  for (const auto& primitive : t.primitives)
    for (const auto c : primitive.clustered.cluster) {
      const auto& cluster = t.clustered.clusters[c];
      for (std::size_t k = 0; k < cluster.weightScale.size(); ++k) {
        double length = 0.0;
        for (std::size_t d = 0; d < cluster.mean.size(); ++d) length += std::pow(cluster.components[k * cluster.mean.size() + d] / 127.0, 2);
        sum += length * std::pow(static_cast<double>(cluster.weightScale[k]), 2) / 12.0;
      }
      vertices += 1.0;
    }
  return sum / vertices / (4.0 * std::numbers::pi);
}


/// Settings under which hardly anything but rounding is lost.
BakeSettings lossless(BakeSettings settings) {
  settings.terms = 256;
  settings.functions = 256;
  settings.clusters = 1;
  settings.functionBits = 16;
  settings.weightBits = 16;
  settings.bytesPerVertex = -1.0;
  return settings;
}

/// A room without windows: `half` about the origin, its faces inwards.
Primitive closedRoom(float half, int cells) {
  const float h = half;
  Primitive room;
  addGrid(room, {-h, -h, h}, {2 * h, 0, 0}, {0, 0, -2 * h}, cells);
  addGrid(room, {-h, h, -h}, {2 * h, 0, 0}, {0, 0, 2 * h}, cells);
  addGrid(room, {-h, -h, -h}, {2 * h, 0, 0}, {0, 2 * h, 0}, cells);
  addGrid(room, {h, -h, h}, {-2 * h, 0, 0}, {0, 2 * h, 0}, cells);
  addGrid(room, {-h, -h, h}, {0, 0, -2 * h}, {0, 2 * h, 0}, cells);
  addGrid(room, {h, -h, -h}, {0, 0, 2 * h}, {0, 2 * h, 0}, cells);
  return room;
}

TEST(ClusteredBake, JointSaysHowGoodItIs) {
  auto settings = kJoint;
  settings.functions = 128;
  settings.clusters = 4;
  const auto b = baked(boxesOnFloor(8), settings);
  expectFinite(b);
  // What a renderer reads of a lobe is off by what the rows are, and by what compression changes: the mean size of that is at most its rms, in the
  // maps that are read (of sharpness 3, 10.5, 36.75 and 128.625).
  const std::map<int, std::vector<int>> maps{{3, {3}}, {10, {3, 11}}, {30, {11, 37}}, {100, {37, 129}}};
  for (const auto& [sharpness, levels] : maps) {
    double change = 0.0;
    for (const int level : levels) change = std::max(change, b["level_rms_" + std::to_string(level)]);
    EXPECT_LE(b.fraction(sharpness), b.fraction(sharpness, true) + change) << sharpness;
  }
  // A wrong sign turns a sharp lobe's fraction over, and a distance that is wrong by ssdf_rms_radians changes the fraction of lobes that are wider.
  for (const int sharpness : {300, 1000, 3000})
    EXPECT_LE(b.fraction(sharpness), b.fraction(sharpness, true) + 2.0 * b["ssdf_sign_share"] + b["ssdf_rms_radians"]) << sharpness;
  for (const int sharpness : kSharpness) {
    // Texels of 64 x 64 are .055 rad wide and edges uncertain to half of that at worst; an average axis is far from any edge.
    EXPECT_LE(b.fraction(sharpness, true), 0.01) << sharpness;
    // Broad lobes are held least closely: they weigh a tenth of a distance.
    EXPECT_LE(b.fraction(sharpness), 0.025) << sharpness;
  }
  EXPECT_LE(std::abs(b.report.bytesPerVertex - b.scene.transfer.bytesPerVertex(b.report.vertices)), 1e-9);
  for (const auto& [name, value] : b.error) EXPECT_EQ(b.scene.facts.at("error." + name), value);
  EXPECT_GT(b.report.terms, 0);
  EXPECT_LE(b.report.terms, 24);
}

TEST(ClusteredBake, ManyTermsLoseOnlyRounding) {
  const auto b = baked(boxesOnFloor(8), lossless(kClustered));
  expectFinite(b);
  // Components and means are bytes: what they leave of one another is fitted by the later ones, and what the last leave is small.
  EXPECT_LE(b["ssdf_rms_radians"], 1e-3);
  EXPECT_LE(b["ssdf_sign_share"], 1e-4);
  const auto joint = baked(boxesOnFloor(8), lossless(kJoint));
  for (const int sharpness : kSharpness) EXPECT_LE(std::abs(joint.fraction(sharpness) - joint.fraction(sharpness, true)), 5e-4) << sharpness;
}

TEST(ClusteredBake, FixedLobesAreThoseOfTheGlobalForm) {
  auto settings = kClustered;
  settings.samplingResolution = settings.resolution;
  const auto clustered = baked(boxesOnFloor(8), settings);
  auto joint = lossless(kJoint);
  joint.samplingResolution = joint.resolution;
  const auto decoded = baked(boxesOnFloor(8), joint);
  settings.compression = Compression::pca;
  BakeReport report;
  const auto global = bake(boxesOnFloor(8), settings, report);
  for (std::size_t p = 0; p < 3; ++p) {
    const auto& expected = global.transfer.primitives[p].visibility;
    EXPECT_EQ(clustered.scene.transfer.primitives[p].visibility, expected);
    const auto& got = decoded.scene.transfer.primitives[p].visibility;
    ASSERT_EQ(got.size(), expected.size());
    // Rounding of rows, functions, components and weights, each well below a step.
    for (std::size_t i = 0; i < got.size(); ++i) ASSERT_LE(std::abs(int{got[i]} - int{expected[i]}), 2);
  }
}

TEST(ClusteredBake, WeightBitsAddTheirRounding) {
  const auto fine = baked(boxesOnFloor(8), lossless(kClustered));
  auto settings = lossless(kClustered);
  settings.weightBits = 8;
  const auto coarse = baked(boxesOnFloor(8), settings);
  const double added = std::pow(coarse["ssdf_rms_radians"], 2) - std::pow(fine["ssdf_rms_radians"], 2);
  // Of a sample of the vertices, and above the horizon only.
  constexpr double kSample = 0.3;
  EXPECT_LE(std::abs(added / weightRounding(coarse.scene.transfer) - 1.0), kSample);
  const auto stored = [](const Baked& b) {
    std::size_t sum = 0;
    for (const auto& p : b.scene.transfer.primitives) sum += p.clustered.weights.size();
    return static_cast<double>(sum);
  };
  EXPECT_EQ(stored(fine), stored(coarse));
  EXPECT_LT(coarse.report.bytesPerVertex, fine.report.bytesPerVertex);
}

TEST(ClusteredBake, FunctionBitsAddTheirRounding) {
  const auto fine = baked(boxesOnFloor(8), lossless(kClustered));
  double last = 0.0;
  for (const int bits : {8, 4}) {
    auto settings = lossless(kClustered);
    settings.functionBits = bits;
    const auto coarse = baked(boxesOnFloor(8), settings);
    const double added = std::pow(coarse["ssdf_rms_radians"], 2) - std::pow(fine["ssdf_rms_radians"], 2);
    constexpr double kSample = 0.3;
    EXPECT_LE(std::abs(added / functionRounding(coarse.scene.transfer) - 1.0), kSample) << bits;
    EXPECT_GT(added, last);
    last = added;
    for (const auto b : coarse.scene.transfer.clustered.functions.bits) EXPECT_EQ(b, bits);
  }
}

TEST(ClusteredBake, MoreSamplesAreBetterForSharpLobes) {
  auto settings = kJoint;
  settings.samplingResolution = 16;
  const auto coarse = baked(boxesOnFloor(8), settings);
  settings.samplingResolution = 128;
  const auto fine = baked(boxesOnFloor(8), settings);
  // Edges are known eight times as well; the SSDF has the same texels, and the truth 512 rays.
  for (const int sharpness : {100, 300, 1000, 3000}) EXPECT_LE(fine.fraction(sharpness, true), 0.5 * coarse.fraction(sharpness, true)) << sharpness;
  for (const int sharpness : {100, 1000}) EXPECT_LE(fine.fraction(sharpness), coarse.fraction(sharpness)) << sharpness;
}

TEST(ClusteredBake, TheSameBytesForAnyNumberOfThreads) {
  for (auto settings : {kJoint, kClustered}) {
    settings.clusters = 5;
    settings.functions = 48;
    settings.terms = 8;
    std::vector<std::uint8_t> one;
    for (const int threads : {1, 2, 5}) {
      settings.threads = threads;
      const auto bytes = bytesOf(baked(boxesOnFloor(10), settings).scene);
      if (threads == 1) one = bytes;
      EXPECT_TRUE(bytes == one) << threads << " threads";
    }
  }
}

void expectSameTransfer(const Transfer& a, const Transfer& b) {
  EXPECT_EQ(a.terms, b.terms);
  EXPECT_EQ(a.mean, b.mean);
  const auto &c = a.clustered, &d = b.clustered;
  EXPECT_EQ(c.levels, d.levels);
  EXPECT_EQ(c.weightBits, d.weightBits);
  EXPECT_EQ(c.functions.bits, d.functions.bits);
  EXPECT_EQ(c.functions.scale, d.functions.scale);
  EXPECT_EQ(c.functions.data, d.functions.data);
  ASSERT_EQ(c.clusters.size(), d.clusters.size());
  for (std::size_t i = 0; i < c.clusters.size(); ++i) {
    EXPECT_EQ(c.clusters[i].terms, d.clusters[i].terms);
    EXPECT_EQ(c.clusters[i].meanScale, d.clusters[i].meanScale);
    EXPECT_EQ(c.clusters[i].mean, d.clusters[i].mean);
    EXPECT_EQ(c.clusters[i].components, d.clusters[i].components);
    EXPECT_EQ(c.clusters[i].weightScale, d.clusters[i].weightScale);
  }
  ASSERT_EQ(a.primitives.size(), b.primitives.size());
  for (std::size_t p = 0; p < a.primitives.size(); ++p) {
    EXPECT_EQ(a.primitives[p].visibility, b.primitives[p].visibility);
    EXPECT_EQ(a.primitives[p].clustered.cluster, b.primitives[p].clustered.cluster);
    EXPECT_EQ(a.primitives[p].clustered.weights, b.primitives[p].clustered.weights);
  }
}

TEST(ClusteredBake, ARoundTripKeepsEveryBit) {
  for (auto settings : {kJoint, kClustered})
    for (const int weightBits : {8, 16}) {
      settings.clusters = 3;
      settings.weightBits = weightBits;
      const auto b = baked(boxesOnFloor(), settings);
      bytesOf(b.scene);
      expectSameTransfer(readBakedScene("clustered.glb").transfer, b.scene.transfer);
    }
}

TEST(ClusteredBake, AnOpenPlaneCostsNoWeights) {
  for (const auto& settings : {kJoint, kClustered}) {
    const auto b = baked(sceneWith({floorGrid(2.0f, 4)}), settings);
    expectFinite(b);
    EXPECT_EQ(b.report.terms, 0);
    for (const auto v : b.scene.transfer.primitives[0].visibility) EXPECT_EQ(v, 255);
    EXPECT_TRUE(b.scene.transfer.primitives[0].clustered.weights.empty());
    EXPECT_EQ(b.scene.transfer.clustered.functions.count(), 0u);
    EXPECT_EQ(b["ssdf_sign_share"], 0.0);
    bytesOf(b.scene);
    expectSameTransfer(readBakedScene("clustered.glb").transfer, b.scene.transfer);
  }
}

TEST(ClusteredBake, InAClosedRoomNothingIsSeen) {
  for (const auto& settings : {kJoint, kClustered}) {
    const auto b = baked(sceneWith({closedRoom(1.0f, 2)}), settings);
    expectFinite(b);
    for (const auto v : b.scene.transfer.primitives[0].visibility) EXPECT_EQ(v, 0);
    EXPECT_EQ(b["ssdf_sign_share"], 0.0);
    // The whole lobe is hidden: the prefiltered maps hold 0; the SSDF knows no more than its clamp, .265 rad, beyond which a lobe of sharpness
    // 100 has erfc(.265 sqrt(50)) / 2 = .004 of its light; a quarter of that is read.
    if (settings.compression != Compression::joint) continue;
    for (const int sharpness : {3, 10, 30}) EXPECT_LE(b.fraction(sharpness), 1e-3) << sharpness;
    EXPECT_LE(b.fraction(100), 2e-3);
  }
}

TEST(ClusteredBake, AtTheBottomOfASlit) {
  Primitive near, far;
  addGrid(near, {-0.05f, 0, 5}, {0, 0, -10}, {0, 2, 0}, 2);
  addGrid(far, {0.05f, 0, -5}, {0, 0, 10}, {0, 2, 0}, 2);
  Primitive floor;
  addGrid(floor, {-0.05f, 0, 5}, {0.1f, 0, 0}, {0, 0, -10}, 4);
  auto settings = kJoint;
  settings.samplingResolution = 128;
  const auto b = baked(sceneWith({floor, near, far}), settings);
  expectFinite(b);
  // A line of .05 rad overhead is all that is seen, and hardly any of a fixed lobe of sharpness 32 (.18 rad).
  const auto& visible = b.scene.transfer.primitives[0].visibility;
  double sum = 0.0;
  for (const auto v : visible) sum += v / 255.0 / static_cast<double>(visible.size());
  EXPECT_GT(sum, 0.0);
  EXPECT_LE(sum, 0.2);
}

TEST(ClusteredBake, HardlyDependsOnScaleAndPlace) {
  const auto original = baked(boxesOnFloor(6), kJoint);
  for (const float scale : {1e-3f, 1e4f}) {
    const auto b = baked(scaled(boxesOnFloor(6), scale), kJoint);
    expectFinite(b);
    // The same signal but for rays through an edge; what these change in the components, 4 bits round anew.
    EXPECT_LE(std::abs(b["ssdf_rms_radians"] / original["ssdf_rms_radians"] - 1.0), 0.05) << scale;
    for (const int sharpness : kSharpness) EXPECT_LE(std::abs(b.fraction(sharpness) - original.fraction(sharpness)), 2e-3) << scale;
  }
  const auto far = baked(scaled(boxesOnFloor(6), 1.0f, glm::vec3(1e4f, -1e4f, 3e3f)), kJoint);
  expectFinite(far);
  EXPECT_LE(std::abs(far["ssdf_rms_radians"] / original["ssdf_rms_radians"] - 1.0), 0.2) << "coordinates of 1e4 are rounded to 1e-3";
}

TEST(ClusteredBake, OneTriangle) {
  Primitive triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.indices = {0, 1, 2};
  for (auto settings : {kJoint, kClustered}) {
    settings.clusters = 64;
    const auto b = baked(sceneWith({triangle}), settings);
    expectFinite(b);
    EXPECT_EQ(b.report.vertices, 3u);
    EXPECT_EQ(b.report.terms, 0);
    EXPECT_EQ(b.scene.transfer.clustered.clusters.size(), 1u);
  }
}

TEST(ClusteredBake, ManyVerticesAtThePlaceOfOthers) {
  // A fan of 5000 triangles beside a box, whose vertices at its middle differ in their normals by a ten-thousandth: more vertices than the
  // shared functions are made from, so that some are projected.
  constexpr int kTriangles = 5000;
  Primitive fan;
  for (int i = 0; i < kTriangles; ++i) {
    const float turn = static_cast<float>(i);
    for (int k = 0; k < 3; ++k) {
      const float phi = 1.5f * (turn + static_cast<float>(k - 1)) / kTriangles;
      fan.positions.push_back(k == 0 ? glm::vec3(0.0f) : glm::vec3(std::sin(phi), 0, std::cos(phi)));
      fan.normals.push_back(k > 0 ? glm::vec3(0, 1, 0) : glm::normalize(glm::vec3(1e-4f * std::sin(turn), 1.0f, 1e-4f * std::cos(turn))));
      fan.indices.push_back(static_cast<std::uint32_t>(fan.indices.size()));
    }
  }
  auto settings = kJoint;
  settings.samplingResolution = 16;
  settings.directionCount = 8;
  settings.clusters = 4;
  const auto scene = [&] { return sceneWith({fan, standingBox({0.2f, 1.6f}, 0.5f, 1.0f, 2)}); };
  const auto many = baked(scene(), settings);
  expectFinite(many);
  EXPECT_GT(many.report.vertices, 9900u);
  const auto& positions = many.scene.scene.primitives[0].positions;
  std::size_t middle = 0;
  std::vector<int> least(8, 255), most(8, 0);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (glm::length(positions[v]) > 0.5f) continue;
    ++middle;
    for (std::size_t j = 0; j < 8; ++j) {
      const int value = many.scene.transfer.primitives[0].visibility[v * 8 + j];
      least[j] = std::min(least[j], value);
      most[j] = std::max(most[j], value);
    }
  }
  EXPECT_GT(middle, 4900u);
  // Equal rows have equal transfer, projected or not, but for rounding and what a ten-thousandth of a radian changes next to the horizon.
  for (std::size_t j = 0; j < 8; ++j) EXPECT_LE(most[j] - least[j], 4) << j;
  for (auto& n : fan.normals) n = {0, 1, 0};
  const auto welded = baked(scene(), settings);
  expectFinite(welded);
  EXPECT_LE(welded.report.vertices, 5002u + 45u);
}

TEST(ClusteredBake, ADoubleSidedSurfaceHasBothSides) {
  auto scene = boxesOnFloor();
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  for (auto& primitive : scene.primitives) primitive.material = 0;
  auto settings = kJoint;
  settings.functions = 96;
  const auto b = baked(scene, settings);
  expectFinite(b);
  for (const int sharpness : kSharpness) EXPECT_LE(b.fraction(sharpness, true), 0.02) << sharpness;
}

TEST(ClusteredBake, ProgressMayStopIt) {
  for (const std::string stop : {"visibility", "shared functions", "clusters", "error"}) {
    BakeReport report;
    auto settings = kJoint;
    settings.threads = 3;
    try {
      bake(boxesOnFloor(10), settings, report, [&](const std::string& stage, double done) {
        EXPECT_TRUE(done >= 0.0 && done <= 1.0) << stage << " " << done;
        if (stage == stop) throw Error(ExitCode::interrupted, "test", "stop", "");
      });
      ADD_FAILURE() << stop << " was never reported";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::interrupted);
    }
  }
}

TEST(ClusteredBake, BytesAVertexAreAnUpperLimit) {
  const auto scene = boxesOnFloor(8);
  auto settings = kJoint;
  settings.functions = 32;
  settings.clusters = 8;
  settings.bytesPerVertex = -1.0;
  const auto whole = baked(scene, settings);
  settings.bytesPerVertex = 0.7 * whole.report.bytesPerVertex;
  const auto part = baked(scene, settings);
  expectFinite(part);
  EXPECT_LE(part.report.bytesPerVertex, 1.01 * settings.bytesPerVertex);
  EXPECT_GE(part.report.bytesPerVertex, 0.95 * settings.bytesPerVertex) << "what is allowed is used";
  EXPECT_GE(part["ssdf_rms_radians"], whole["ssdf_rms_radians"]);
  // Nothing but means fits; that is a bake too.
  settings.bytesPerVertex = 1.0;
  const auto none = baked(scene, settings);
  expectFinite(none);
  EXPECT_EQ(none.report.terms, 0);
}

TEST(ClusteredBake, TheTargetErrorIsKeptWithFewBytes) {
  const auto scene = boxesOnFloor(16);
  auto settings = kJoint;
  double worst = 0.0, before = 1e9;
  for (const double target : {0.012, 0.06}) {
    settings.targetError = target;
    const auto b = baked(scene, settings);
    worst = 0.0;
    for (const int sharpness : kSharpness) worst = std::max(worst, b.fraction(sharpness));
    EXPECT_FALSE(b.report.missedTarget);
    EXPECT_LE(worst, target);
    EXPECT_LT(b.report.bytesPerVertex, before);
    before = b.report.bytesPerVertex;
  }
}

TEST(ClusteredBake, ATargetErrorOutOfReachIsSaid) {
  auto settings = kJoint;
  settings.targetError = 1e-6;
  const auto b = baked(boxesOnFloor(4), settings);
  EXPECT_TRUE(b.report.missedTarget);
  // As good as the traced rows but for rounding.
  for (const int sharpness : kSharpness) EXPECT_LE(std::abs(b.fraction(sharpness) - b.fraction(sharpness, true)), 0.01) << sharpness;
}

TEST(ClusteredBake, RefusesWhatItCannotDo) {
  const auto refused = [](const auto& change) {
    for (auto settings : {kJoint, kClustered}) {
      change(settings);
      BakeReport report;
      try {
        bake(sceneWith({floorGrid(1.0f, 1)}), settings, report);
        return false;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::usage) << error.what();
      }
    }
    return true;
  };
  for (const int clusters : {-1, 4097}) EXPECT_TRUE(refused([&](BakeSettings& s) { s.clusters = clusters; })) << clusters;
  for (const int functions : {-1, 1025}) EXPECT_TRUE(refused([&](BakeSettings& s) { s.functions = functions; })) << functions;
  for (const int bits : {-8, 0, 4, 12, 32}) EXPECT_TRUE(refused([&](BakeSettings& s) { s.weightBits = bits; })) << bits;
  for (const int bits : {-4, 1, 5, 12, 32}) EXPECT_TRUE(refused([&](BakeSettings& s) { s.functionBits = bits; })) << bits;
  for (const double bytes : {std::nan(""), HUGE_VAL}) EXPECT_TRUE(refused([&](BakeSettings& s) { s.bytesPerVertex = bytes; })) << bytes;
  for (const double error : {-0.1, 1.0, std::nan("")}) EXPECT_TRUE(refused([&](BakeSettings& s) { s.targetError = error; })) << error;
  EXPECT_TRUE(refused([&](BakeSettings& s) { s.targetError = 0.02, s.bytesPerVertex = 50.0; }));
  for (const int sampling : {-16, 8, 15, 24, 48, 2048, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
    EXPECT_TRUE(refused([&](BakeSettings& s) { s.samplingResolution = sampling; })) << sampling;
  for (const int resolution : {8, 20, 28, 264}) {
    EXPECT_TRUE(refused([&](BakeSettings& s) {
      s.resolution = resolution;
      s.samplingResolution = 0;
    })) << resolution;
  }
  for (const auto& [resolution, sampling] : {std::pair{16, 0}, {16, 16}, {24, 96}, {40, 80}})
    EXPECT_FALSE(refused([&, r = resolution, s2 = sampling](BakeSettings& s) {
      s.resolution = r;
      s.samplingResolution = s2;
    })) << resolution;
  BakeReport report;
  EXPECT_THROW(bake(Scene{}, kJoint, report), Error);
}

}  // namespace
}  // namespace chiaro
