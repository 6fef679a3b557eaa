// `chiaro-report visibility` as its user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/file.h"
#include "tests/programs/browser.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Finished report(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "visibility");
  return runProgram("chiaro-report", arguments);
}

/// A few coarse figures in a second.
std::vector<std::string> quick(std::vector<std::string> more) {
  const std::vector<std::string> cheap{"--vertices",   "3",  "--points-inside", "2", "--rays",           "64",
                                       "--resolution", "16", "--terms",         "4", "--basis-vertices", "60"};
  more.insert(more.end(), cheap.begin(), cheap.end());
  return more;
}

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

TEST(ReportVisibility, WritesEverythingItSays) {
  const Finished run = report(quick({"builtin:sphere", "--ground", "--figures", "-o", "signal", "--json", "signal.json"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(textOf("signal/visibility.json"), textOf("signal.json"));
  EXPECT_EQ(textOf("signal/visibility.txt"), run.out);
  EXPECT_THAT(run.out, HasSubstr("bytes/vertex"));
  const auto json = nlohmann::json::parse(textOf("signal.json"));
  EXPECT_EQ(json["program"], "chiaro-report visibility");
  EXPECT_EQ(json["settings"]["rays"], 64);
  EXPECT_EQ(json["sharpness"], nlohmann::json::parse("[3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0]"));
  ASSERT_EQ(json["scenes"].size(), 1u);
  const auto& scene = json["scenes"][0];
  EXPECT_EQ(scene["scene"], "builtin:sphere");
  EXPECT_EQ(scene["ground"], true);
  EXPECT_EQ(scene["points_at_vertices"], 3);
  EXPECT_EQ(scene["points_in_triangles"], 2);
  EXPECT_EQ(scene["basis_vertices"], 60);
  ASSERT_EQ(scene["methods"].size(), 11u);
  for (const auto& method : scene["methods"]) {
    SCOPED_TRACE(method["name"]);
    const double each = method["bytes_each_vertex"], shared = method["bytes_shared"], vertices = scene["vertices"];
    EXPECT_NEAR(method["bytes_per_vertex"].get<double>(), each + shared / vertices, 1e-9);
    for (const auto* place : {"mean_abs_at_vertices", "mean_abs_in_triangles"}) {
      ASSERT_EQ(method[place].size(), 7u);
      for (const auto& value : method[place]) EXPECT_TRUE(value.is_number() && value >= 0.0 && value <= 1.0) << value;
    }
  }
  const std::string csv = textOf("signal/visibility.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 11);

  std::vector<std::string> ids;
  for (const auto& figure : scene["figures"]) {
    ids.push_back(figure["id"]);
    SCOPED_TRACE(ids.back());
    EXPECT_EQ(figure["curves"].size(), ids.back() == "product" ? 5u : 3u);
    for (const auto& curve : figure["curves"])
      for (const auto& value : curve["y"]) EXPECT_TRUE(value.is_number() && value >= 0.0) << value;
  }
  EXPECT_THAT(ids, testing::ElementsAre("product", "terms_vertices_10", "terms_vertices_100", "terms_vertices_1000", "terms_triangles_10", "terms_triangles_100", "terms_triangles_1000"));
  const std::string figures = textOf("signal/visibility_figures.csv");
  EXPECT_EQ(std::count(figures.begin(), figures.end(), '\n'), 1 + 5 * 13 + 6 * 3 * 4);
  if (!chromium()) return;
  const std::string dom = documentAfter("signal/index.html", R"(
    const root = document.documentElement.dataset;
    root.figures = document.querySelectorAll('figure svg').length;
    const rows = () => [...document.querySelectorAll('#scene0_vertices tbody tr')].map(row => Number(row.cells[1].dataset.value));
    document.querySelectorAll('#scene0_vertices th button')[1].click();
    root.sorted = rows().length === 11 && rows().every((value, i, all) => i === 0 || all[i - 1] <= value);
    root.fits = document.documentElement.scrollWidth <= innerWidth;
  )");
  EXPECT_THAT(dom.substr(0, 1000), testing::Not(HasSubstr("data-error")));
  for (const char* state : {"data-figures=\"7\"", "data-sorted=\"true\"", "data-fits=\"true\""}) EXPECT_THAT(dom.substr(0, 1000), HasSubstr(state));
}

TEST(ReportVisibility, BakedTransferIsMeasured) {
  bakeSmallScene("baked.glb");
  const Finished run = report(quick({"baked.glb", "builtin:sphere", "--json", "baked.json", "-q"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out + run.err, "");
  const auto json = nlohmann::json::parse(textOf("baked.json"));
  ASSERT_EQ(json["scenes"].size(), 2u);
  EXPECT_THAT(json["scenes"][0]["methods"][0]["name"].get<std::string>(), StartsWith("baked"));
  EXPECT_EQ(json["scenes"][0]["methods"].size(), 12u);
  EXPECT_EQ(json["scenes"][1]["methods"].size(), 11u);
  expectFailure(report(quick({"baked.glb", "--ground"})), 2, "--ground");
}

TEST(ReportVisibility, Errors) {
  expectFailure(report({}), 2, "scenes");
  expectFailure(report({"builtin:sphere", "--rays", "1"}), 2, "--rays");
  expectFailure(report({"builtin:sphere", "--resolution", "30"}), 2, "--resolution");
  expectFailure(report({"builtin:sphere", "--vertices", "0", "--points-inside", "0"}), 2, "--vertices");
  expectFailure(report({"builtin:sphere", "--no-such-option"}), 2, "--no-such-option");
  expectFailure(report({"builtin:cube", "-q"}), 2, "builtin:cube");
  expectFailure(report({"missing.ply", "-q"}), 3, "missing.ply");
  expectFailure(report({"missing.glb", "-q"}), 3, "missing.glb");
  expectFailure(report({"builtin:sphere", "--json", "no/such/folder.json", "-q"}), 4, "no/such");
}

}  // namespace
}  // namespace chiaro
