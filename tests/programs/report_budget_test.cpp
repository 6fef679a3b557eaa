// `chiaro-report budget`: its stages, and the program as its user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/file.h"
#include "assets/scene/load_scene.h"
#include "tests/programs/browser.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string textOf(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

class ReportBudget : public testing::Test {
 protected:
  /// Coarse, with eight bytes a vertex, so that every stage shows.
  static void SetUpTestSuite() {
    std::filesystem::remove_all("budget");
    run_ = runProgram("chiaro-report", {"budget", "builtin:sphere", "--ground", "-o", "budget", "--vertices", "40", "--points-inside", "40", "--rays", "256", "--resolution", "16", "--bytes", "8",
                                        "--size", "32x24", "--samples", "1024", "--rays-per-lobe", "16", "--upsample", "2", "-r", "0.3"});
  }
  static Finished run_;
};

Finished ReportBudget::run_;

TEST_F(ReportBudget, AddsUpToTheBakesErrorAndEndsInNoise) {
  ASSERT_EQ(run_.code, 0) << run_.err;
  const auto json = nlohmann::json::parse(textOf("budget/budget.json"));
  const auto& stages = json["stages"];
  ASSERT_EQ(stages.size(), 6u);
  EXPECT_LE(json["bytes_per_vertex"], 1.02 * 8.0);
  for (const std::string place : {"vertices", "triangles"})
    for (std::size_t s = 0; s < 7; ++s) {
      SCOPED_TRACE(place + " " + std::to_string(s));
      double sum = 0.0;
      for (const auto& stage : stages) sum += stage["caused_" + place][s].get<double>();
      EXPECT_NEAR(sum, stages[0]["error_" + place][s].get<double>(), 1e-12);
      // The exact form differs from the truth by its own noise and that of the truth: 2048 stratified directions against twice 128. Three times the truth's, as
      // its halves have half its rays, and .001 for what 80 points cannot tell.
      const double left = stages[5]["error_" + place][s];
      EXPECT_LE(left, 3.0 * json["truth_noise"][s].get<double>() + 1e-3);
      EXPECT_LT(left, stages[0]["error_" + place][s].get<double>());
    }
  // At a vertex nothing is interpolated.
  for (std::size_t s = 0; s < 7; ++s) EXPECT_LE(std::abs(stages[4]["caused_vertices"][s].get<double>()), 0.004) << s;
  ASSERT_EQ(json["worst_points"].size(), 12u);
  double sum = 0.0;
  for (std::size_t s = 0; s < 7; ++s) sum += 40.0 * (stages[0]["error_vertices"][s].get<double>() + stages[0]["error_triangles"][s].get<double>()) / 7.0;
  double before = 1.0, found = 0.0;
  for (const auto& one : json["worst_points"]) {
    const double error = one["error"];
    EXPECT_TRUE(error <= before && error > sum / 80.0) << error << ", the mean is " << sum / 80.0;
    EXPECT_GE(one["largest"], error);
    before = error;
    found += error;
  }
  EXPECT_LE(found, sum);
  const auto& vertices = json["worst_vertices"];
  ASSERT_EQ(vertices.size(), 8u);
  for (std::size_t i = 1; i < 8; ++i) EXPECT_LE(vertices[i]["error"], vertices[i - 1]["error"]);
  EXPECT_GE(vertices[7]["error"], json["vertex_error"]["percentile_95"]);
  // Every vertex by 24 rays a lobe, whose noise is in it, and some by 256.
  double mean = 0.0;
  for (std::size_t s = 0; s < 7; ++s) mean += stages[0]["error_vertices"][s].get<double>() / 7.0;
  EXPECT_GE(json["vertex_error"]["mean"], 0.8 * mean);
  EXPECT_LE(json["vertex_error"]["mean"], mean + 0.01);
  const Scene mesh = loadScene("budget/error.glb");
  EXPECT_EQ(mesh.triangleCount(), json["triangles"].get<std::size_t>());
  const std::string csv = textOf("budget/budget.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 6);
  EXPECT_THAT(run_.out, HasSubstr("half-space and maps"));
}

TEST_F(ReportBudget, APicturesErrorAddsUpAndEndsInNoise) {
  ASSERT_EQ(run_.code, 0) << run_.err;
  const auto json = nlohmann::json::parse(textOf("budget/budget.json"))["pictures"];
  const auto& stages = json["stages"];
  ASSERT_EQ(stages.size(), 8u);
  EXPECT_GT(json["pixels"], 150);
  EXPECT_LT(json["pixels_left_out"], json["pixels"].get<int>() / 10);
  for (const std::string figure : {"rmse", "linear_rmse", "flip"}) {
    double sum = 0.0;
    for (const auto& stage : stages) {
      EXPECT_TRUE(stage[figure].is_number() && stage[figure] > 0.0) << stage;
      sum += stage["caused_" + figure].get<double>();
    }
    EXPECT_NEAR(sum, stages[0][figure].get<double>(), 1e-12) << figure;
  }
  // What is left is what the noises of both sides explain; a quarter for how well some hundred pixels tell it.
  const double left = stages[7]["rmse"], noise = std::hypot(json["reference_noise"].get<double>(), json["exact_noise"].get<double>());
  EXPECT_NEAR(left / noise, json["left_over_noise"].get<double>(), 1e-9);
  EXPECT_NEAR(left / noise, 1.0, 0.25);
  // Eight bytes a vertex show: traced visibility is closer, and all exact is closest.
  EXPECT_LT(stages[2]["rmse"], stages[1]["rmse"]);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT(left, stages[i]["rmse"].get<double>()) << i;
  const std::string csv = textOf("budget/budget_pictures.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 8);
  EXPECT_THAT(run_.out, HasSubstr("texture filtering"));
}

TEST_F(ReportBudget, PageInABrowser) {
  if (!chromium()) GTEST_SKIP() << "no chromium: install it, or name it in CHIARO_CHROMIUM";
  ASSERT_EQ(run_.code, 0) << run_.err;
  const std::string dom = documentAfter("budget/index.html", R"(
    const root = document.documentElement.dataset;
    root.bars = ['vertices', 'triangles', 'pictures'].map(place => Chart.getChart('chart_' + place).data.datasets.length).join();
    root.marks = document.querySelectorAll('.marked span').length > 0 && document.querySelectorAll('#worst_vertices img').length === 8;
    root.inked = [...document.querySelectorAll('canvas')].every(canvas => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some(value => value !== 0));
    root.fits = document.documentElement.scrollWidth <= innerWidth;
  )");
  EXPECT_THAT(dom.substr(0, 1000), Not(HasSubstr("data-error")));
  for (const char* state : {"data-bars=\"6,6,3\"", "data-marks=\"true\"", "data-inked=\"true\"", "data-fits=\"true\""}) EXPECT_THAT(dom.substr(0, 1000), HasSubstr(state));
}

TEST_F(ReportBudget, Errors) {
  const auto expectFailure = [](const std::vector<std::string>& arguments, int code, const std::string& part) {
    const Finished run = runProgram("chiaro-report", arguments);
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_EQ(run.errorLines(), 1) << run.err;
    EXPECT_THAT(run.err, StartsWith("chiaro-report: "));
    EXPECT_THAT(run.err, HasSubstr(part));
  };
  expectFailure({"budget", "missing.ply", "-o", "budget_none"}, 3, "missing.ply");
  expectFailure({"budget", "builtin:sphere", "-o", "budget_none", "--resolution", "256"}, 2, "--resolution");
  expectFailure({"budget", "builtin:sphere", "-o", "budget_none", "--vertices", "0"}, 2, "--vertices");
  expectFailure({"budget", "builtin:sphere", "-o", "budget_none", "--samples", "9"}, 2, "--samples");
  expectFailure({"budget", "builtin:sphere", "-o", "budget_none", "-e", "no_such_light"}, 3, "no_such_light");
  EXPECT_FALSE(std::filesystem::exists("budget_none"));
  writeFileAtomically("a_file", std::string_view("x"));
  expectFailure({"budget", "builtin:sphere", "-o", "a_file/budget"}, 4, "a_file");
}

}  // namespace
}  // namespace chiaro
