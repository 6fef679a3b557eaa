// Bakes that are stopped and go on, and bakes that may use little memory: the same bytes as undisturbed ones.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/bake.h"
#include "tests/precompute/bake_scenes.h"

namespace chiaro {
namespace {

constexpr const char* kJournal = "resume.glb.partial";
constexpr std::size_t kSample = 8192;  // vertices that the shared functions are made from

// More vertices than the sample has.
Scene largeScene() { return boxesOnFloor(92); }

BakeSettings settingsOf(Compression compression) {
  return {.compression = compression, .resolution = 16, .samplingResolution = 16, .terms = 8, .clusters = 8, .functions = 32, .directionCount = 8};
}

std::vector<std::uint8_t> bytesOf(const BakedScene& baked) {
  writeBakedScene("resume.glb", baked, "resume test");
  return readFile("resume.glb");
}

std::string nameOf(const testing::TestParamInfo<Compression>& info) {
  return info.param == Compression::pca ? "pca" : info.param == Compression::clustered ? "clustered" : "joint";
}

struct Undisturbed {
  std::vector<std::uint8_t> bytes;
  BakeReport report;
};

// Baked once for each form, in memory alone.
const Undisturbed& undisturbed(Compression compression) {
  static std::map<Compression, Undisturbed> all;
  auto& result = all[compression];
  if (result.bytes.empty()) {
    auto settings = settingsOf(compression);
    settings.threads = 2;
    result.bytes = bytesOf(bake(largeScene(), settings, result.report));
  }
  return result;
}

// Bakes until `stage` is that far, and stops there.
BakeReport stoppedAt(const std::string& stage, double share, const BakeSettings& settings, const BakeStorage& storage) {
  BakeReport report;
  try {
    bake(largeScene(), settings, report, [&](const std::string& name, double done) {
      if (name == stage && done >= share) throw Error(ExitCode::interrupted, "test", "stop", "");
    }, storage);
    ADD_FAILURE() << stage << " was never at " << share;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::interrupted) << error.what();
  }
  return report;
}

struct ResumeTest : testing::TestWithParam<Compression> {
  void SetUp() override { std::filesystem::remove(kJournal); }
  void TearDown() override { std::filesystem::remove(kJournal); }
};
INSTANTIATE_TEST_SUITE_P(Forms, ResumeTest, testing::Values(Compression::pca, Compression::clustered, Compression::joint), nameOf);

TEST_P(ResumeTest, StoppedDamagedAndResumedIsTheSameBytes) {
  const auto& expected = undisturbed(GetParam());
  ASSERT_GT(expected.report.vertices, kSample + 256) << "or nothing is traced behind the sample";
  EXPECT_EQ(expected.report.verticesResumed, 0u);

  auto settings = settingsOf(GetParam());
  std::vector<std::string> notices;
  const BakeStorage storage{.journal = kJournal, .program = "test", .notice = [&](const std::string& line) { notices.push_back(line); }};
  // In the sample, in what comes behind it, and in a later stage.
  std::size_t before = 0;
  const std::pair<std::string, double> stops[]{{"visibility", 0.1}, {"visibility", 0.15}, {"visibility", 0.6}, {"visibility", 0.985}, {"error", 0.1}};
  for (const auto& [stage, share] : stops) {
    settings.threads = settings.threads == 1 ? 3 : 1;
    const auto report = stoppedAt(stage, share, settings, storage);
    EXPECT_GE(report.verticesResumed, before) << "what was finished once is not traced again";
    before = report.verticesResumed;
  }
  EXPECT_GE(before, expected.report.vertices * 97 / 100);
  EXPECT_EQ(notices.size(), std::size(stops) - 1);
  EXPECT_NE(notices.back().find(kJournal), std::string::npos);
  EXPECT_EQ(stoppedAt("error", 0.1, settings, storage).verticesResumed, expected.report.vertices);

  // Bytes of contents here and there, of headers too by chance, and a torn end.
  auto journal = readFile(kJournal);
  for (std::size_t place = 5000; place < journal.size(); place += journal.size() / 7) journal[place] ^= 16;
  journal.resize(journal.size() - 10);
  writeFileAtomically(kJournal, journal);
  BakeReport report;
  EXPECT_TRUE(bytesOf(bake(largeScene(), settings, report, {}, storage)) == expected.bytes);
  EXPECT_LT(report.verticesResumed, report.vertices);
  EXPECT_EQ(report.raysTraced, expected.report.raysTraced);

  // The whole journal is still there, as only the caller knows when the output is safe.
  auto fresh = storage;
  fresh.fresh = true;
  EXPECT_EQ(stoppedAt("visibility", 0.3, settings, fresh).verticesResumed, 0u);
  EXPECT_GT(stoppedAt("visibility", 0.3, settings, storage).verticesResumed, 0u);
  settings.directionCount = 12;
  EXPECT_EQ(stoppedAt("visibility", 0.01, settings, storage).verticesResumed, 0u);
  EXPECT_NE(notices.back().find("starts anew"), std::string::npos) << notices.back();
}

TEST_P(ResumeTest, AMemoryLimitNeverChangesTheBytes) {
  auto settings = settingsOf(GetParam());
  settings.threads = 2;
  BakeStorage storage{.journal = kJournal, .program = "test", .memoryLimit = 1};
  BakeReport report;
  std::string refusal;
  try {
    bake(largeScene(), settings, report, [](const std::string&, double) { FAIL() << "work was begun"; }, storage);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    refusal = error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(kJournal));
  std::smatch least;
  ASSERT_TRUE(std::regex_search(refusal, least, std::regex("^--memory-limit: .* are too few .*: give at least ([0-9]+)$"))) << refusal;
  // So little that all rows are read back from the journal.
  storage.memoryLimit = (std::stoul(least[1]) + 2) << 20;
  EXPECT_TRUE(bytesOf(bake(largeScene(), settings, report, {}, storage)) == undisturbed(GetParam()).bytes);
}

TEST(Resume, SettingsOfWhatComesAfterTracingAreFree) {
  auto settings = settingsOf(Compression::joint);
  std::filesystem::remove(kJournal);
  const BakeStorage storage{.journal = kJournal, .program = "test"};
  stoppedAt("clusters", 0.0, settings, storage);
  settings.terms = 6;
  BakeReport report;
  const auto expected = bytesOf(bake(largeScene(), settings, report));
  EXPECT_TRUE(bytesOf(bake(largeScene(), settings, report, {}, storage)) == expected);
  EXPECT_EQ(report.verticesResumed, report.vertices);
  std::filesystem::remove(kJournal);
}

}  // namespace
}  // namespace chiaro
