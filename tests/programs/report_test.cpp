// chiaro-report as its user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/image.h"
#include "assets/transfer/transfer.h"
#include "runtime/gl/context.h"
#include "tests/programs/browser.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kScene = "report_scene.glb";

Finished report(const std::vector<std::string>& arguments) { return runProgram("chiaro-report", arguments); }

std::string textOf(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

void expectFailure(const Finished& run, int code, const std::string& part) {
  EXPECT_EQ(run.code, code) << run.err;
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, StartsWith("chiaro-report: "));
  EXPECT_THAT(run.err, HasSubstr(part));
}

class ReportFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() { bakeSmallScene(kScene); }
};

class ReportPictures : public ReportFiles {
 protected:
  void SetUp() override {
    try {
      gl::HeadlessContext context;
    } catch (const Error& error) {
      GTEST_SKIP() << "no OpenGL 4.5 on this machine: " << error.what();
    }
  }
  static std::vector<std::string> small(const std::string& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{kScene, "-o", folder, "--size", "64x48", "--samples", "16", "-e", "white"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

TEST_F(ReportFiles, UsageErrors) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{}, "baked"},
      {{kScene}, "--output"},
      {{kScene, "-o", "r", "--size", "64"}, "--size"},
      {{kScene, "-o", "r", "--size", "64x0"}, "--size"},
      {{kScene, "-o", "r", "--size", "64x99999"}, "--size"},
      {{kScene, "-o", "r", "-r", "1.5"}, "--roughness"},
      {{kScene, "-o", "r", "-r", "nan"}, "--roughness"},
      {{kScene, "-o", "r", "--metallic", "-1"}, "--metallic"},
      {{kScene, "-o", "r", "--samples", "1"}, "--samples"},
      {{kScene, "-o", "r", "--exposure", "0"}, "--exposure"},
      {{kScene, "-o", "r", "--tone-map", "film"}, "--tone-map: unknown tone map \"film\""},
      {{kScene, "-o", "r", "--error-map", "heat"}, "--error-map: unknown error map \"heat\""},
      {{kScene, "-o", "r", "--fail-under", "nan"}, "--fail-under"},
      {{kScene, "-o", "r", "--fail-over", "-1"}, "--fail-over"},
      {{kScene, "-o", "r", "--fail-over", "nan"}, "--fail-over"},
      {{kScene, "-o", "r", "--threads", "-1"}, "--threads"},
      {{kScene, "-o", "r", "--camera", "eye=1"}, "--camera"},
      {{kScene, "-o", "r", "--no-such-option"}, "--no-such-option"},
  };
  for (const auto& [arguments, part] : cases) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expectFailure(report(arguments), 2, part);
  }
}

TEST_F(ReportFiles, UnreadableAndUnwritable) {
  expectFailure(report({"missing.glb", "-o", "r", "-q"}), 3, "missing.glb");
  EXPECT_FALSE(std::filesystem::exists("r"));
  expectFailure(report({kScene, "missing.glb", "-o", "r", "-q"}), 3, "missing.glb");
  EXPECT_FALSE(std::filesystem::exists("r"));
  // Before the first picture, which may take long, and before a folder is made.
  expectFailure(report({kScene, "-o", "never", "-e", "sunny", "-e", "tpyo.hdr"}), 3, "tpyo.hdr");
  EXPECT_FALSE(std::filesystem::exists("never"));
  writeFileAtomically("not_a_scene.glb", std::string_view("glTF nonsense"));
  expectFailure(report({"not_a_scene.glb", "-o", "r/deep/", "-q"}), 3, "not_a_scene.glb");
  EXPECT_FALSE(std::filesystem::exists("r"));
  writeFileAtomically("a_file", std::string_view("x"));
  expectFailure(report({kScene, "-o", "a_file/report", "-q"}), 4, "a_file");
}

TEST_F(ReportPictures, WritesEverythingItSays) {
  const Finished run = report(small("full", {"-r", "0.4", "-r", "0.8", "-e", "overcast", "--metallic", "0"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("full/index.html"));
  const auto json = nlohmann::json::parse(textOf("full/report.json"));
  ASSERT_EQ(json["cases"].size(), 4u);
  EXPECT_EQ(json["size"], nlohmann::json::parse("[64, 48]"));
  double lowest = 1e9;
  for (const auto& one : json["cases"]) {
    SCOPED_TRACE(one["name"]);
    EXPECT_GT(one["object_pixels"], 500);
    EXPECT_EQ(one["undefined_pixels"], 0);
    // One pixel in fifty at most: the two decide differently about centres that an edge crosses.
    EXPECT_LE(one["coverage_mismatches"], 64 * 48 / 50);
    const double rmse = one["rmse"], psnr = one["psnr_db"], noise = one["reference_noise_rms"];
    EXPECT_NEAR(psnr, -20 * std::log10(rmse), 1e-6);
    // The same scene, light, camera and exposure: what remains is a coarse bake and 16 samples of noise.
    EXPECT_GE(psnr, 20.0);
    EXPECT_GT(noise, 0.0);
    EXPECT_LE(one["rmse_without_noise"], 0.1);
    // Near enough to be the same scene, noisy enough not to be the same picture.
    EXPECT_TRUE(one["ssim"] > 0.5 && one["ssim"] < 1.0) << one["ssim"];
    EXPECT_TRUE(one["flip"] > 0.0 && one["flip"] < 0.3) << one["flip"];
    EXPECT_TRUE(one["hdr_flip"] > 0.0 && one["hdr_flip"] < 0.6) << one["hdr_flip"];
    EXPECT_GE(one["hdr_flip_exposures"]["count"], 2);
    lowest = std::min(lowest, psnr);
    for (const auto& [kind, file] : one["pictures"].items()) {
      const Image8 image = readPng("full/" + file.get<std::string>());
      EXPECT_EQ(image.width, 64) << kind;
      EXPECT_EQ(image.height, 48) << kind;
    }
  }
  EXPECT_EQ(json["lowest_psnr_db"].get<double>(), lowest);
  const std::string csv = textOf("full/report.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  const std::string page = textOf("full/index.html");
  std::size_t pictures = 0;
  for (std::size_t at = page.find("data:image/png"); at != std::string::npos; at = page.find("data:image/png", at + 1))
    ++pictures;
  std::size_t crops = 0;
  for (const auto& one : json["cases"]) crops += 2 * one["worst_pixels"].size();
  EXPECT_GT(crops, 0u);
  EXPECT_EQ(pictures, 12u + crops);
}

TEST_F(ReportPictures, SameFiguresForAnyThreadCount) {
  ASSERT_EQ(report(small("one", {"--threads", "1", "-q"})).code, 0);
  ASSERT_EQ(report(small("three", {"--threads", "3", "-q"})).code, 0);
  EXPECT_EQ(readFile("one/white_reference.png"), readFile("three/white_reference.png"));
  EXPECT_EQ(readFile("one/white_runtime.png"), readFile("three/white_runtime.png"));
}

TEST_F(ReportPictures, LimitDecidesTheExitCode) {
  const Finished strict = report(small("strict", {"--fail-under", "140", "-q"}));
  expectFailure(strict, 5, "under the limit");
  EXPECT_TRUE(std::filesystem::exists("strict/index.html"));  // to look at what failed
  EXPECT_EQ(report(small("lenient", {"--fail-under", "5", "--fail-over", "0.2", "-q"})).code, 0);
}

TEST_F(ReportPictures, RmseDecidesTheExitCode) {
  expectFailure(report(small("over", {"--fail-over", "0", "-q"})), 5, "over the limit");
  EXPECT_TRUE(std::filesystem::exists("over/index.html"));
}

TEST_F(ReportPictures, TwoBakes) {
  auto same = small("same", {"--fail-over", "0", "-q"});
  same.insert(same.begin() + 1, kScene);
  ASSERT_EQ(report(same).code, 0) << "a bake does not differ from itself";
  EXPECT_EQ(readFile("same/white_runtime.png"), readFile("same/white_reference.png"));

  BakedScene changed = readBakedScene(kScene);
  for (auto& material : changed.scene.materials) material.baseColorFactor *= glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  writeBakedScene("darker.glb", changed, "report tests");
  auto other = small("pair", {"--fail-over", "0.001", "-q"});
  other.insert(other.begin() + 1, "darker.glb");
  expectFailure(report(other), 5, "over the limit of 0.00100");
  const auto json = nlohmann::json::parse(textOf("pair/report.json"));
  EXPECT_EQ(json["compared_with"], "darker.glb");
  EXPECT_EQ(json["fail_over"], 0.001);
  EXPECT_EQ(json["highest_rmse"], json["cases"][0]["rmse"]);
  EXPECT_EQ(json["cases"][0]["reference_noise_rms"], 0.0);
  EXPECT_EQ(json["cases"][0]["rays_traced"], 0);
  EXPECT_GT(json["cases"][0]["bias"], 0.01) << "the first of the two is the brighter one";
}

TEST_F(ReportPictures, PageInABrowser) {
  if (!chromium()) GTEST_SKIP() << "no chromium: install it, or name it in CHIARO_CHROMIUM";
  ASSERT_EQ(report(small("page", {"-q", "-e", "overcast"})).code, 0);
  const std::string dom = documentAfter("page/index.html", R"(
    const root = document.documentElement.dataset, compare = document.querySelector('.compare'), slider = compare.querySelector('input');
    const cut = () => getComputedStyle(compare.querySelector('.over')).clipPath;
    const before = cut();
    slider.value = 20;
    slider.dispatchEvent(new Event('input'));
    root.slider = before.includes('50%') && cut().includes('20%');
    const images = [...document.images];
    const column = () => [...document.querySelectorAll('#cases tbody tr')].map(row => Number(row.cells[1].dataset.value));
    document.querySelectorAll('#cases th button')[1].click();
    root.sorted = column().length === 2 && column()[0] <= column()[1];
    root.marks = document.querySelectorAll('.marked span').length === document.querySelectorAll('[id^=worst_] tbody tr').length;
    root.fits = document.documentElement.scrollWidth <= innerWidth;
    Promise.all(images.map(image => image.decode())).then(() => { root.drawn = images.length > 6; });
  )");
  EXPECT_THAT(dom.substr(0, 1000), Not(HasSubstr("data-error")));
  for (const char* state : {"data-slider=\"true\"", "data-sorted=\"true\"", "data-marks=\"true\"", "data-fits=\"true\"", "data-drawn=\"true\""})
    EXPECT_THAT(dom.substr(0, 1000), HasSubstr(state));
}

TEST_F(ReportPictures, ErrorMapsOfFlip) {
  ASSERT_EQ(report(small("difference", {"-q"})).code, 0);
  ASSERT_EQ(report(small("flip", {"-q", "--error-map", "flip"})).code, 0);
  ASSERT_EQ(report(small("hdr_flip", {"-q", "--error-map", "hdr-flip"})).code, 0);
  EXPECT_NE(readFile("difference/white_error.png"), readFile("flip/white_error.png"));
  EXPECT_NE(readFile("flip/white_error.png"), readFile("hdr_flip/white_error.png"));
  EXPECT_EQ(readFile("difference/white_runtime.png"), readFile("flip/white_runtime.png"));
}

TEST_F(ReportPictures, SaysWhichLampsAreLeftOut) {
  bakeSceneOfLamps("lamps.glb", 33);
  auto arguments = small("lamps");
  arguments[0] = "lamps.glb";
  const Finished run = report(arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("chiaro-report: warning: lamps.glb: 33 punctual lights: only the first 32 are drawn"));
}

TEST_F(ReportPictures, QuietIsQuiet) {
  const Finished run = report(small("quiet", {"-q"}));
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST_F(ReportPictures, CameraThatSeesNothingSaysSo) {
  expectFailure(report(small("nothing", {"-q", "--camera", "eye=0,50,0,target=0,100,0"})), 1, "no pixel shows the scene");
}

TEST_F(ReportPictures, TwoFilesOfOneNameKeepApart) {
  const Finished run = report(small("twins", {"-q", "-e", "white"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists("twins/white_runtime.png"));
  EXPECT_TRUE(std::filesystem::exists("twins/white_2_runtime.png"));
}

}  // namespace
}  // namespace chiaro
