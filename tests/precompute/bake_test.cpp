// The whole bake on small scenes: what it must find, that it says truly how good it is, and that nothing but its input decides its bytes.
#include "precompute/bake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/compression/encode.h"
#include "precompute/parallel.h"
#include "precompute/ssdf/ssdf.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

constexpr BakeSettings kCoarse{.compression = Compression::pca, .resolution = 16, .terms = 24, .directionCount = 16};

std::vector<std::uint8_t> bytesOf(const BakedScene& baked, const std::string& name) {
  writeBakedScene(name, baked, "bake test");
  return readFile(name);
}

std::map<std::string, double> errorsOf(const BakeReport& report) { return {report.error.begin(), report.error.end()}; }

TEST(Bake, AnOpenPlaneCostsNothing) {
  BakeReport report;
  const auto baked = bake(sceneWith({floorGrid(2.0f, 4)}), kCoarse, report);
  EXPECT_EQ(report.vertices, 25u);
  EXPECT_EQ(report.triangles, 32u);
  EXPECT_EQ(report.terms, 0);
  EXPECT_EQ(report.raysTraced, 25u * 16u * 16u / 2u) << "the map's texels are symmetric about y = 0";
  for (const float m : baked.transfer.mean) EXPECT_LE(std::abs(m - kMaxDistance), 1e-4f);
  for (const auto v : baked.transfer.primitives[0].visibility) EXPECT_EQ(v, 255);
  for (const auto& [name, value] : report.error) EXPECT_LE(value, 1e-3) << name;
  bytesOf(baked, "open.glb");
  EXPECT_EQ(readBakedScene("open.glb").transfer.terms, 0);
}

TEST(Bake, SaysHowGoodItIs) {
  BakeReport report;
  const auto baked = bake(boxesOnFloor(8), kCoarse, report);
  const auto error = errorsOf(report);
  EXPECT_GT(report.terms, 0);
  EXPECT_LE(std::abs(error.at("ssdf_rms_radians") / error.at("ssdf_discarded_rms_radians") - 1.0), 1e-3)
      << "rounding adds in squares to what PCA leaves out";
  EXPECT_LE(error.at("ssdf_quantisation_rms_radians"), 0.002);
  EXPECT_GT(error.at("ssdf_sign_share"), 0.0);
  EXPECT_LE(error.at("ssdf_sign_share"), 0.1);
  for (const int sharpness : {10, 30, 100, 300, 1000, 3000}) {
    // A map of 16 x 16 has texels of .22 rad: even the exact distance is that coarse.
    EXPECT_LE(error.at("visible_fraction_mean_abs_" + std::to_string(sharpness)), 0.1) << sharpness;
    EXPECT_LE(error.at("visible_fraction_uncompressed_mean_abs_" + std::to_string(sharpness)), 0.1) << sharpness;
  }
  EXPECT_LE(std::abs(report.bytesPerVertex - baked.transfer.bytesPerVertex(report.vertices)), 1e-9);
  for (const auto& [name, value] : report.error) EXPECT_EQ(baked.facts.at("error." + name), value);
}

TEST(Bake, MoreTermsAndTexelsAreBetter) {
  std::map<std::string, double> coarse, fine;
  BakeReport report;
  bake(boxesOnFloor(8), {.compression = Compression::pca, .resolution = 16, .terms = 4, .directionCount = 8}, report);
  coarse = errorsOf(report);
  bake(boxesOnFloor(8), {.compression = Compression::pca, .resolution = 64, .terms = 64, .directionCount = 8}, report);
  fine = errorsOf(report);
  EXPECT_LE(fine.at("ssdf_rms_radians"), 0.3 * coarse.at("ssdf_rms_radians"));
  EXPECT_LE(fine.at("ssdf_sign_share"), 0.5 * coarse.at("ssdf_sign_share"));
  // ALGORITHMS 3.3, half-space picture of the exact distance: .017 rms at sharpness 1000. Ours is a mean, and has texels.
  EXPECT_LE(fine.at("visible_fraction_uncompressed_mean_abs_1000"), 0.017);
  EXPECT_LE(fine.at("visible_fraction_mean_abs_1000"), 0.03);
}

TEST(Bake, TheSameBytesForAnyNumberOfThreads) {
  auto settings = kCoarse;
  std::vector<std::uint8_t> one;
  for (const int threads : {1, 2, 5}) {
    settings.threads = threads;
    BakeReport report;
    const auto bytes = bytesOf(bake(boxesOnFloor(10), settings, report), "threads.glb");
    if (threads == 1) one = bytes;
    EXPECT_TRUE(bytes == one) << threads << " threads";
  }
}

TEST(Bake, SurvivesExtremesOfScaleAndPlace) {
  BakeReport original;
  bake(boxesOnFloor(6), kCoarse, original);
  for (const float scale : {1e-3f, 1e4f}) {
    BakeReport report;
    bake(scaled(boxesOnFloor(6), scale), kCoarse, report);
    EXPECT_EQ(report.vertices, original.vertices);
    EXPECT_EQ(report.terms, original.terms);
    // The same signal but for rays through an edge.
    EXPECT_LE(std::abs(errorsOf(report).at("ssdf_rms_radians") / errorsOf(original).at("ssdf_rms_radians") - 1.0), 0.05) << scale;
  }
  BakeReport far;
  bake(scaled(boxesOnFloor(6), 1.0f, glm::vec3(1e4f, -1e4f, 3e3f)), kCoarse, far);
  EXPECT_LE(std::abs(errorsOf(far).at("ssdf_rms_radians") / errorsOf(original).at("ssdf_rms_radians") - 1.0), 0.2)
      << "coordinates of 1e4 are rounded to 1e-3";
}

TEST(Bake, ARoundTripKeepsTheTransfer) {
  BakeReport report;
  const auto baked = bake(boxesOnFloor(), kCoarse, report);
  writeBakedScene("trip.glb", baked, "bake test");
  const auto read = readBakedScene("trip.glb");
  EXPECT_EQ(read.transfer.mean, baked.transfer.mean);
  EXPECT_EQ(read.transfer.eigenfunctions, baked.transfer.eigenfunctions) << "already halves";
  ASSERT_EQ(read.transfer.primitives.size(), baked.transfer.primitives.size());
  for (std::size_t p = 0; p < baked.transfer.primitives.size(); ++p) {
    EXPECT_EQ(read.transfer.primitives[p].weights, baked.transfer.primitives[p].weights);
    EXPECT_EQ(read.transfer.primitives[p].visibility, baked.transfer.primitives[p].visibility);
  }
}

TEST(Bake, RefusesWhatItCannotDo) {
  const auto expectUsage = [](BakeSettings settings) {
    BakeReport report;
    try {
      bake(boxesOnFloor(), settings, report);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage) << error.what();
    }
  };
  expectUsage({.resolution = 12});
  expectUsage({.resolution = 260});
  expectUsage({.resolution = 18});
  expectUsage({.terms = -1});
  expectUsage({.terms = 257});
  expectUsage({.directionCount = 6});
  expectUsage({.directionCount = 68});
  expectUsage({.directionCount = 10});
  expectUsage({.directionSharpness = 0.0f});
  expectUsage({.directionSharpness = std::numeric_limits<float>::quiet_NaN()});
  BakeReport report;
  EXPECT_THROW(bake(Scene{}, kCoarse, report), Error);
}

TEST(Bake, ProgressMayStopIt) {
  for (const std::string stop : {"visibility", "compression", "error"}) {
    BakeReport report;
    auto settings = kCoarse;
    settings.threads = 3;
    try {
      bake(boxesOnFloor(10), settings, report, [&](const std::string& stage, double done) {
        EXPECT_TRUE(done >= 0.0 && done <= 1.0);
        if (stage == stop) throw Error(ExitCode::interrupted, "test", "stop", "");
      });
      ADD_FAILURE() << stop << " was never reported";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::interrupted);
    }
  }
}

TEST(ParallelBlocks, DoEachBlockOnceAndPassOnWhatIsThrown) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> count(1000, 0);
    parallelBlocks(threads, count.size(), [&](std::size_t i) { ++count[i]; });
    EXPECT_EQ(std::count(count.begin(), count.end(), 1), 1000);
    EXPECT_THROW(parallelBlocks(threads, 100, [](std::size_t i) { if (i == 50) throw std::runtime_error("block"); }), std::runtime_error);
    parallelBlocks(threads, 0, [](std::size_t) { FAIL(); });
  }
}

}  // namespace
}  // namespace chiaro
