// `chiaro-report brdf` and what it measures with.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "assets/file.h"
#include "precompute/report/brdf/brdf_study.h"
#include "precompute/report/brdf/cosine_figure.h"
#include "precompute/report/brdf/factorisation.h"
#include "precompute/report/brdf/view_error.h"
#include "runtime/brdf/reflectance_table.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using namespace lobe64;
using testing::HasSubstr;
using testing::Not;

std::string textOf(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

/// A line of the warp's exact smooth factor: `count` lobes, 0 for none.
double errorOfWarp(int kind, double parameter, double sharpness, int count) {
  const ReflectanceModel model = reflectanceModel(kind, parameter, parameter);
  const SphericalGaussian lobe = sphericalGaussian(Vec3(0, 0, 1), sharpness, 1.0);
  const auto reconstruction = [&](const Vec3& wo) -> Slice {
    return [&, wo](const Vec3& wi) {
      double sum = count == 0 ? sgEvaluate(lobe, halfVector(wo, wi)) : 0.0;
      for (int k = 0; k < count; ++k) sum += sgEvaluate(sgWarpLobe(lobe, wo, count, k), wi);
      return sum * smoothTimesCosine(model, wo, wi);
    };
  };
  return viewError(model, reconstruction, kHalfPi, {.views = 32, .viewAzimuths = 1, .radii = 80, .azimuths = 32});
}

// ALGORITHMS 2.4, within 10 %.
TEST(BrdfErrors, PublishedTable) {
  struct Row {
    int kind;
    double parameter, half, isotropic;
  };
  for (const Row& row : {Row{kCookTorrance, .1, 1.0e-6, .098}, Row{kCookTorrance, .3, 6.6e-5, .083}, Row{kCookTorrance, .5, 2.6e-4, .057}, Row{kBlinnPhong, 10, 1.4e-3, .0175},
                         Row{kBlinnPhong, 100, 3.4e-5, .0145}}) {
    const double sharpness = ndfPaperLobe(row.kind, row.parameter).y;
    EXPECT_NEAR(errorOfWarp(row.kind, row.parameter, sharpness, 0) / row.half, 1.0, .1) << row.parameter;
    EXPECT_NEAR(errorOfWarp(row.kind, row.parameter, sharpness, 1) / row.isotropic, 1.0, .1) << row.parameter;
  }
}

TEST(BrdfErrors, PublishedFactorisations) {
  struct Row {
    int kind;
    double parameter, terms16, terms64, terms256;
  };
  for (const Row& row : {Row{kCookTorrance, .1, .527, .172, .0147}, Row{kBlinnPhong, 100, .103, 3.7e-3, 2.9e-6}, Row{kBlinnPhong, 500, .480, .137, 7.3e-3}}) {
    const auto errors = factorisationErrors(reflectanceModel(row.kind, row.parameter, row.parameter), kHalfPi, 112, 256, {16, 64, 256});
    EXPECT_NEAR(errors[0] / row.terms16, 1.0, .1);
    EXPECT_NEAR(errors[1] / row.terms64, 1.0, .1);
    EXPECT_NEAR(errors[2] / row.terms256, 1.0, .1);
  }
  const auto elongated = factorisationErrors(reflectanceModel(kAshikhminShirley, 100, 10), kHalfPi, 40, 96, {16, 64});
  EXPECT_NEAR(elongated[0] / .099, 1.0, .1);
  EXPECT_NEAR(elongated[1] / .0084, 1.0, .1);
}

// Both ways of factoring the same round model.
TEST(BrdfErrors, FactorisationsAgree) {
  const auto round = factorisationErrors(reflectanceModel(kWard, .5, .5), kHalfPi, 24, 48, {4, 16});
  const auto mirrored = factorisationErrors(reflectanceModel(kWard, .5, .5 * (1 + 1e-9)), kHalfPi, 24, 48, {4, 16});
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(round[k] / mirrored[k], 1.0, 1e-3);
}

// ALGORITHMS 1.11.
TEST(BrdfErrors, ClampedCosine) {
  const Figure figure = cosineFigure();
  const std::vector<std::vector<double>> expected{{.1774, .1116, .0837, .0579}, {.1256, .0902, .0831}, {.7906, .3536, .0884, .0884, .0442, .0442, .0276, .0276, .0193, .0193, .0145, .0145}};
  for (std::size_t c = 0; c < expected.size(); ++c) {
    ASSERT_EQ(figure.curves[c].y.size(), expected[c].size());
    for (std::size_t i = 0; i < expected[c].size(); ++i) EXPECT_NEAR(figure.curves[c].y[i], expected[c][i], 2e-4) << figure.curves[c].name << ' ' << i;
  }
}

// The committed choice is at most a little worse than the best at points on and off its grid.
TEST(BrdfErrors, WarpChoiceIsTheMeasuredOne) {
  for (double sharpness : {2.0, 8.0, 64.0, 1024.0, 16384.0})
    for (double cosine : {.2, .5, .8, 1.0}) {
      double least = std::numeric_limits<double>::infinity(), leastRound = least;
      for (int way = 0; way < 4; ++way) {
        const double error = warpError(way, sharpness, cosine);
        least = std::min(least, error);
        if (way != kWarpAnisotropic) leastRound = std::min(leastRound, error);
      }
      EXPECT_LE(warpError(warpChoice(sharpness, cosine, false), sharpness, cosine), 1.03 * least + 2e-7) << sharpness << ' ' << cosine;
      EXPECT_LE(warpError(warpChoice(sharpness, cosine, true), sharpness, cosine), 1.03 * leastRound + 2e-7) << sharpness << ' ' << cosine;
    }
}

TEST(ReportBrdf, WritesEverythingAndTheErrorsHold) {
  const Finished run = runProgram("chiaro-report", {"brdf", "--quick", "-o", "brdf", "--json", "brdf.json"});
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  EXPECT_EQ(textOf("brdf/brdf.json"), textOf("brdf.json"));
  const auto json = nlohmann::json::parse(textOf("brdf.json"));
  EXPECT_EQ(json["program"], "chiaro-report brdf");
  ASSERT_EQ(json["figures"].size(), 10u);
  std::size_t points = 0;
  for (const auto& figure : json["figures"])
    for (const auto& curve : figure["curves"]) {
      ASSERT_EQ(curve["x"].size(), curve["y"].size());
      points += curve["x"].size();
    }
  const std::string csv = textOf("brdf/brdf.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), points + 1);
  ASSERT_EQ(json["models"].size(), 5u * 4u);
  for (const auto& row : json["models"]) {
    SCOPED_TRACE(row.dump());
    EXPECT_TRUE(row["holds"].get<bool>());
    EXPECT_LE(row["ours_75"].get<double>(), row["limit"].get<double>());
  }
  ASSERT_EQ(json["elongated"].size(), 3u);
  for (const auto& row : json["elongated"]) EXPECT_LE(row["error_75"][3].get<double>(), .0105) << row.dump();  // a coarse grid; GGX is at its limit
  const std::string page = textOf("brdf/index.html");
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, Not(HasSubstr("http")));  // nothing from outside
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(ReportBrdf, Errors) {
  const auto expectFailure = [](std::vector<std::string> arguments, int code, const std::string& part) {
    arguments.insert(arguments.begin(), "brdf");
    const Finished run = runProgram("chiaro-report", arguments);
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_EQ(run.errorLines(), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(part));
  };
  expectFailure({"--threads", "-1"}, 2, "--threads");
  expectFailure({"extra"}, 2, "extra");
  expectFailure({"--json", "no/such/folder.json"}, 4, "no/such");
}

}  // namespace
}  // namespace chiaro
