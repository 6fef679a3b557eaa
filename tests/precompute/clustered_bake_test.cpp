// The clustered forms of a bake on small scenes: how good they are, that nothing but the input decides their bytes, and extremes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

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

TEST(ClusteredBake, MEASURE) {
  const auto show = [](const char* name, const Baked& b) {
    printf("== %s terms %d bytes %.1f clusters %zu functions %zu\n", name, b.report.terms, b.report.bytesPerVertex, b.scene.transfer.clustered.clusters.size(), b.scene.transfer.clustered.functions.count());
    for (auto& [n, v] : b.report.error) printf("  %s %.5f\n", n.c_str(), v);
  };
  show("joint", baked(boxesOnFloor(8), kJoint));
  show("clustered", baked(boxesOnFloor(8), kClustered));
  auto s = kJoint; s.samplingResolution = 16;
  show("joint coarse", baked(boxesOnFloor(8), s));
  s = kJoint; s.samplingResolution = 256;
  show("joint 256", baked(boxesOnFloor(8), s));
  s = kJoint; s.weightBits = 16;
  show("joint w16", baked(boxesOnFloor(8), s));
  for (int bits : {4, 8, 16}) { s = kJoint; s.functionBits = bits; s.weightBits = 16; show(("f" + std::to_string(bits)).c_str(), baked(boxesOnFloor(8), s)); }
  show("open joint", baked(sceneWith({floorGrid(2.0f, 4)}), kJoint));
  show("open clustered", baked(sceneWith({floorGrid(2.0f, 4)}), kClustered));
  for (float scale : {1e-3f, 1e4f}) show("scale", baked(scaled(boxesOnFloor(8), scale), kJoint));
}

}  // namespace
}  // namespace chiaro
