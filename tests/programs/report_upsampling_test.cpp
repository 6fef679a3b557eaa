// `chiaro-report upsampling` as its user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/file.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;

TEST(ReportUpsampling, MeasuresEveryVariantAndDrawsIt) {
  ASSERT_EQ(runProgram("chiaro-precompute", {"builtin:sphere", "-o", "upsampling_sphere.glb", "--sample-resolution", "64", "-q"}).code, 0);
  std::filesystem::remove_all("upsampling");
  const Finished run = runProgram("chiaro-report", {"upsampling", "upsampling_sphere.glb", "-o", "upsampling", "--size", "48x32", "--frames", "2", "--material", "ggx=0.2", "-q"});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = nlohmann::json::parse(readFile("upsampling/upsampling.json"));
  ASSERT_EQ(json["materials"].size(), 1u);
  const auto& material = json["materials"][0];
  EXPECT_EQ(material["material"], "ggx_0.2");
  ASSERT_EQ(material["variants"].size(), 5u);
  for (const auto& variant : material["variants"]) {
    SCOPED_TRACE(variant["name"].get<std::string>());
    const double rmse = variant["rmse"], flip = variant["flip"], share = variant["recomputed_share"];
    EXPECT_TRUE(rmse > 0.0 && rmse < 0.5) << rmse;
    EXPECT_TRUE(flip > 0.0 && flip < 0.5) << flip;
    const bool recomputes = variant["name"] == "lobe_recomputed" || variant["name"] == "normal_recomputed";
    EXPECT_TRUE(recomputes ? share > 0.0 && share <= 0.1 : share == 0.0) << share;
    EXPECT_TRUE(std::filesystem::exists("upsampling/ggx_0.2_" + variant["name"].get<std::string>() + ".png"));
  }
  EXPECT_TRUE(std::filesystem::exists("upsampling/ggx_0.2_full.png"));
}

TEST(ReportUpsampling, RefusesWhatItCannotCompare) {
  const auto refused = [](std::vector<std::string> more, int code, const std::string& message) {
    more.insert(more.begin(), {"upsampling", "upsampling_none.glb"});
    const Finished run = runProgram("chiaro-report", more);
    EXPECT_EQ(run.code, code);
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  refused({"--upsample", "1"}, 2, "--upsample: 1 is what the others are compared with");
  refused({"--material", "ggx"}, 2, "\"ggx\" is not a model and its width");
  refused({"--variant", "lobes"}, 2, "--variant: \"lobes\" is none: give one of lobe, normal,");
  refused({"--recompute-budget", "2ms"}, 2, "figures would depend on the machine");
  refused({"--recompute-budget", "nan%"}, 2, "is not a budget");
  refused({"--frames", "10000", "--size", "1920x1080"}, 2, "need more than 8 GB");
  refused({"--moving-deg", "2"}, 2, "--moving");
  refused({}, 3, "upsampling_none.glb");
}

}  // namespace
}  // namespace chiaro
