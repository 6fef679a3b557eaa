// `chiaro-report stability` as its user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/file.h"
#include "shaders/parity/parity.h"
#include "tests/programs/browser.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ReportStability, HasEveryFunctionAndItsWorstInputs) {
  std::filesystem::remove_all("stability");
  const Finished run = runProgram("chiaro-report", {"stability", "--no-gl", "-o", "stability", "-q"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out + run.err, "");
  const auto bytes = readFile("stability/stability.json");
  const auto json = nlohmann::json::parse(bytes);
  const auto& cases = parity::allCases();
  ASSERT_EQ(json["functions"].size(), cases.size());
  EXPECT_TRUE(json["gl_renderer"].is_null());
  std::size_t repeated = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& one = json["functions"][i];
    const auto& c = cases[i];
    SCOPED_TRACE(c.name);
    EXPECT_EQ(one["name"], c.name);
    EXPECT_EQ(one["samples"], c.sampleCount());
    EXPECT_EQ(one["float"]["failures"], 0);
    EXPECT_LE(one["float"]["worst"], c.tolerance);
    EXPECT_LE(one["float"]["median"], one["float"]["worst"]);
    EXPECT_TRUE(one["glsl"].is_null());
    // A step of a float is between 2^-24 and 2^-23 of its size.
    const double worst = one["float"]["worst"], ulps = one["float"]["worst_ulps"];
    EXPECT_TRUE(ulps >= 0.999 * worst * 8388608.0 && ulps <= 2.001 * worst * 8388608.0) << worst << " " << ulps;
    // A scalar function at its worst inputs is as wrong as the report says.
    if (c.outputCount != 1 || c.groups.size() != 1 || worst == 0.0) continue;
    lobe32::KernelInput in32{};
    lobe64::KernelInput in64{};
    for (std::size_t k = 0; k < one["float"]["worst_inputs"].size(); ++k) {
      const auto& value = one["float"]["worst_inputs"][k];
      in32.v[k] = value.is_number() ? value.get<float>() : std::stof(value.get<std::string>());
      in64.v[k] = static_cast<double>(in32.v[k]);
    }
    float got[25] = {};
    double expected[25] = {};
    c.run32(in32, got);
    c.run64(in64, expected);
    const double floor = parity::kFloor * c.scale(in32.v);
    EXPECT_NEAR(std::abs(static_cast<double>(got[0]) - expected[0]) / std::max(std::abs(expected[0]), floor), worst, 1e-9 + 1e-6 * worst);
    ++repeated;
  }
  EXPECT_GT(repeated, 10u);

  if (!chromium()) GTEST_SKIP() << "the figures are right; no chromium to look at the page: install it, or name it in CHIARO_CHROMIUM";
  const std::string dom = documentAfter("stability/index.html", R"(
    const root = document.documentElement.dataset, canvas = document.getElementById('chart');
    root.inked = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some(value => value !== 0);
    root.rows = document.querySelectorAll('#functions tbody tr').length === Chart.getChart('chart').data.labels.length;
    document.querySelectorAll('#functions th button')[2].click();
    const ulps = [...document.querySelectorAll('#functions tbody tr')].map(row => Number(row.cells[2].dataset.value));
    root.sorted = ulps.every((value, i) => i === 0 || ulps[i - 1] <= value);
    root.fits = document.documentElement.scrollWidth <= innerWidth;
  )");
  EXPECT_THAT(dom.substr(0, 1000), Not(HasSubstr("data-error")));
  for (const char* state : {"data-inked=\"true\"", "data-rows=\"true\"", "data-sorted=\"true\"", "data-fits=\"true\""}) EXPECT_THAT(dom.substr(0, 1000), HasSubstr(state));
}

TEST(ReportStability, Errors) {
  EXPECT_EQ(runProgram("chiaro-report", {"stability", "--no-gl", "--no-such-option"}).code, 2);
  EXPECT_EQ(runProgram("chiaro-report", {"stability", "--no-gl", "--json", "no/such/folder.json"}).code, 4);
  writeFileAtomically("a_file", std::string_view("x"));
  const Finished run = runProgram("chiaro-report", {"stability", "--no-gl", "-o", "a_file/stability"});
  EXPECT_EQ(run.code, 4);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

}  // namespace
}  // namespace chiaro
