// The pieces of chiaro-report: figures, error map, tables, page.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "assets/error.h"
#include "precompute/report/base64.h"
#include "precompute/report/error_map.h"
#include "precompute/report/metrics.h"
#include "precompute/report/metrics/worst_pixels.h"
#include "precompute/report/report_page.h"
#include "precompute/report/report_tables.h"

namespace chiaro {
namespace {

using testing::HasSubstr;
using testing::Not;

// Below .76 the neutral tone map only shifts dark ends; "clamp" leaves sRGB encoding alone, which is easy to reason with.
constexpr DisplaySettings kPlain{1.0f, ToneMap::clamp};

double srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

ImageRgba flat(int width, int height, glm::vec4 value) {
  return {width, height, std::vector<glm::vec4>(static_cast<std::size_t>(width * height), value)};
}

ReferenceHalves noiseless(const ImageRgba& image) { return {image, image}; }

TEST(Metrics, EqualPicturesAreEqual) {
  const ImageRgba image = flat(4, 3, {0.2f, 0.4f, 0.6f, 1.0f});
  const PictureDifference d = comparePictures(image, noiseless(image), kPlain);
  EXPECT_EQ(d.objectPixels, 12u);
  EXPECT_EQ(d.undefinedPixels, 0u);
  EXPECT_EQ(d.coverageMismatches, 0u);
  EXPECT_EQ(d.rmse, 0.0);
  EXPECT_EQ(d.psnr, kHighestPsnr);
  EXPECT_EQ(d.worst, 0.0);
}

TEST(Metrics, KnownDifferenceOnObjectPixelsAlone) {
  ImageRgba reference = flat(2, 2, {0.2f, 0.2f, 0.2f, 1.0f}), picture = reference;
  picture.texels[0] = {0.3f, 0.2f, 0.2f, 1.0f};  // one channel of one pixel
  reference.texels[3].a = 0.0f;                  // background: however different, it does not count
  picture.texels[3] = {9.0f, 9.0f, 9.0f, 0.0f};
  const PictureDifference d = comparePictures(picture, noiseless(reference), kPlain);
  const double error = srgb(0.3) - srgb(0.2);
  EXPECT_EQ(d.objectPixels, 3u);
  EXPECT_NEAR(d.rmse, error / 3.0, 1e-6);  // one of nine
  EXPECT_NEAR(d.psnr, -20 * std::log10(error / 3.0), 1e-3);
  EXPECT_NEAR(d.bias, error / 9.0, 1e-6);
  EXPECT_NEAR(d.meanAbsolute, error / 9.0, 1e-6);
  EXPECT_NEAR(d.worst, error, 1e-6);
}

TEST(Metrics, ExposureAndToneMapAreApplied) {
  const ImageRgba reference = flat(1, 1, {0.2f, 0.2f, 0.2f, 1.0f}), picture = flat(1, 1, {0.3f, 0.3f, 0.3f, 1.0f});
  EXPECT_NEAR(comparePictures(picture, noiseless(reference), {2.0f, ToneMap::clamp}).rmse, srgb(0.6) - srgb(0.4), 1e-6);
  EXPECT_EQ(comparePictures(picture, noiseless(reference), {100.0f, ToneMap::clamp}).rmse, 0.0);  // both white
}

TEST(Metrics, OneUndefinedPixelSpoilsEveryFigure) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const ImageRgba good = flat(3, 1, {0.2f, 0.2f, 0.2f, 1.0f});
  for (const float bad : {nan, inf, -inf}) {
    ImageRgba spoilt = good;
    spoilt.texels[1].g = bad;
    for (const PictureDifference& d :
         {comparePictures(spoilt, noiseless(good), kPlain), comparePictures(good, noiseless(spoilt), kPlain)}) {
      EXPECT_EQ(d.undefinedPixels, 1u);
      for (const double figure :
           {d.rmse, d.psnr, d.bias, d.meanAbsolute, d.worst, d.rmseWithoutNoise, psnrOf(d.rmseWithoutNoise)})
        EXPECT_TRUE(std::isnan(figure));
    }
  }
}

TEST(Metrics, OutlinesThatDifferAreCounted) {
  ImageRgba reference = flat(4, 1, {0.2f, 0.2f, 0.2f, 1.0f}), picture = reference;
  picture.texels[0].a = 0.0f;
  reference.texels[3].a = 0.0f;
  const PictureDifference d = comparePictures(picture, noiseless(reference), kPlain);
  EXPECT_EQ(d.coverageMismatches, 2u);
  EXPECT_EQ(d.objectPixels, 3u);
}

TEST(Metrics, NoiseOfTheReferenceIsMeasuredAndTakenOut) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr double kError = 0.01, kNoise = 0.05;  // noise of a half, display-encoded; its mean has 1/sqrt 2 of it
  const auto linear = [](double shown) { return static_cast<float>(std::pow((shown + 0.055) / 1.055, 2.4)); };
  ImageRgba picture = flat(200, 200, glm::vec4(glm::vec3(linear(0.5 + kError)), 1.0f));
  ReferenceHalves halves = noiseless(flat(200, 200, glm::vec4(1.0f)));
  for (ImageRgba* half : {&halves.first, &halves.second})
    for (glm::vec4& texel : half->texels)
      for (int c = 0; c < 3; ++c) texel[c] = linear(0.5 + kNoise * normal(random));
  const PictureDifference d = comparePictures(picture, halves, kPlain);
  EXPECT_NEAR(d.noise, kNoise / std::sqrt(2.0), 0.02 * kNoise);
  // 120000 channels: the standard error of the mean product is 0.05^2 / sqrt(120000) = 7e-6, of a square of 1e-4.
  // The mean of the halves is taken before encoding, which bends the noise a little.
  EXPECT_NEAR(d.rmse * d.rmse, kError * kError + d.noise * d.noise, 1e-4);
  EXPECT_NEAR(d.rmseWithoutNoise, kError, 0.15 * kError);
}

TEST(Metrics, NeverClaimsMoreThanTheSamplesTell) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.1f, 0.9f);
  ReferenceHalves halves = noiseless(flat(20, 20, glm::vec4(1.0f)));
  for (ImageRgba* half : {&halves.first, &halves.second})
    for (glm::vec4& texel : half->texels)
      for (int c = 0; c < 3; ++c) texel[c] = uniform(random);
  const PictureDifference d = comparePictures(meanOf(halves), halves, kPlain);  // "perfect", yet the truth is not known that well
  EXPECT_GT(d.rmseWithoutNoise, 0.01);
}

TEST(Metrics, RefusesWhatCannotBeCompared) {
  const ImageRgba a = flat(2, 2, glm::vec4(1.0f)), b = flat(3, 2, glm::vec4(1.0f)), empty = flat(2, 2, glm::vec4(0.0f));
  EXPECT_THROW(comparePictures(a, noiseless(b), kPlain), Error);
  EXPECT_THROW(comparePictures(a, noiseless(empty), kPlain), Error);
}

TEST(ErrorMap, ColoursSayWhichWay) {
  ImageRgba reference = flat(5, 1, {0.2f, 0.2f, 0.2f, 1.0f}), picture = reference;
  picture.texels[1] = {0.9f, 0.9f, 0.9f, 1.0f};
  picture.texels[2] = {0.0f, 0.0f, 0.0f, 1.0f};
  picture.texels[3].g = std::numeric_limits<float>::quiet_NaN();
  reference.texels[4].a = 0.0f;
  const Image8 map = errorMap(picture, reference, kPlain);
  const auto texel = [&](std::size_t i) {
    return std::vector<int>{map.texels[4 * i], map.texels[4 * i + 1], map.texels[4 * i + 2], map.texels[4 * i + 3]};
  };
  EXPECT_EQ(texel(0), (std::vector<int>{0, 0, 0, 255}));
  EXPECT_EQ(texel(1), (std::vector<int>{255, 255, 0, 255}));
  EXPECT_EQ(texel(2), (std::vector<int>{0, 255, 255, 255}));
  EXPECT_EQ(texel(3), (std::vector<int>{255, 0, 255, 255}));
  EXPECT_EQ(texel(4), (std::vector<int>{48, 48, 48, 255}));
}

TEST(Base64, MatchesTheStandard) {
  const auto encoded = [](std::string text) { return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); };
  EXPECT_EQ(encoded(""), "");  // RFC 4648, section 10
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

Comparisons oneCase(const std::string& environment) {
  Comparison one;
  one.name = "case";
  one.environment = environment;
  one.runtime = one.reference = flat(2, 2, {0.2f, 0.2f, 0.2f, 1.0f});
  one.difference = comparePictures(one.runtime, noiseless(one.reference), kPlain);
  Comparisons all;
  all.cases.push_back(one);
  return all;
}

TEST(Page, EscapesNamesAndNeedsNothingElse) {
  Comparisons comparisons = oneCase("a<b>&\"c'.hdr");
  ReportOptions options;
  options.scene = "x<script>.glb";
  const std::string page = reportPage({}, options, comparisons, {{{1}, {2}, {3}}});
  EXPECT_THAT(page, Not(HasSubstr("x<script")));
  EXPECT_THAT(page, HasSubstr("x&lt;script&gt;.glb"));
  EXPECT_THAT(page, HasSubstr("a&lt;b&gt;&amp;&quot;c&#39;.hdr"));
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,AQ=="));
  EXPECT_THAT(page, HasSubstr("name=\"viewport\""));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme:dark"));
}

TEST(WorstPixels, AreApartAndInOrder) {
  const ImageRgba reference = flat(40, 20, {0.2f, 0.2f, 0.2f, 1.0f});
  ImageRgba picture = reference;
  picture.at(10, 5).r += 0.3f;
  picture.at(12, 6).r += 0.2f;  // near a worse one
  picture.at(30, 15) -= glm::vec4(0.1f, 0.1f, 0.1f, 0.0f);
  picture.at(0, 0).r = std::numeric_limits<float>::quiet_NaN();
  const auto worst = worstPixels(picture, reference, kPlain, 5, 4);
  ASSERT_EQ(worst.size(), 2u) << "the others do not differ";
  EXPECT_EQ(std::pair(worst[0].x, worst[0].y), std::pair(10, 5));
  EXPECT_EQ(std::pair(worst[1].x, worst[1].y), std::pair(30, 15));
  const double bright = static_cast<double>(displayColor({0.5f, 0.2f, 0.2f}, kPlain.exposure, kPlain.toneMap).r - displayColor({0.2f, 0.2f, 0.2f}, kPlain.exposure, kPlain.toneMap).r);
  EXPECT_NEAR(worst[0].difference, bright / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(worst[0].bias, bright / 3.0, 1e-6);
  EXPECT_LT(worst[1].bias, 0.0);
  ASSERT_EQ(worstPixels(picture, reference, kPlain, 5, 1).size(), 3u);
  EXPECT_EQ(worstPixels(picture, reference, kPlain, 1, 1).size(), 1u);
  ImageRgba nothing = reference;
  for (auto& texel : nothing.texels) texel.a = 0.0f;
  EXPECT_TRUE(worstPixels(picture, nothing, kPlain, 5, 1).empty());
}

TEST(Tables, UndefinedFiguresAreNullAndEmpty) {
  Comparisons comparisons = oneCase("sunny, \"late\"");
  comparisons.cases[0].runtime.texels[0].r = std::numeric_limits<float>::quiet_NaN();
  comparisons.cases[0].difference =
      comparePictures(comparisons.cases[0].runtime, noiseless(comparisons.cases[0].reference), kPlain);
  const auto json = nlohmann::json::parse(reportJson({}, {}, comparisons));
  EXPECT_TRUE(json["lowest_psnr_db"].is_null());
  EXPECT_TRUE(json["cases"][0]["psnr_db"].is_null());
  EXPECT_TRUE(json["cases"][0]["roughness"].is_null());
  EXPECT_EQ(json["cases"][0]["undefined_pixels"], 1);
  const std::string csv = reportCsv(comparisons);
  EXPECT_THAT(csv, HasSubstr("case,\"sunny, \"\"late\"\"\",,,,,,,,4,1,0,,,,"));
  EXPECT_TRUE(std::isnan(lowestPsnr(comparisons)));
}

}  // namespace
}  // namespace chiaro
