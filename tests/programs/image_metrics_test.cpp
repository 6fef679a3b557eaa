// RMSE, PSNR, SSIM and FLIP against published figures, against figures that other programs computed, and against a plain second version.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "assets/error.h"
#include "precompute/report/metrics/flip.h"
#include "precompute/report/metrics/flip_color.h"
#include "precompute/report/metrics/magma.h"
#include "precompute/report/metrics/rmse.h"
#include "precompute/report/metrics/ssim.h"
#include "tests/programs/naive_metrics.h"

namespace chiaro {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
const double kPixelsPerDegree = FlipSettings{}.pixelsPerDegree;
// Four digits of values near 1; the figures below are given to more.
constexpr double kFourDigits = 5e-5;
// Two programs in double on the same floats; the authors' colour constants have nine digits.
constexpr double kSameFormula = 1e-6;

ImageRgb flat(int width, int height, glm::vec3 value) {
  return {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width * height), value)};
}

struct Pair {
  ImageRgb reference, test;
};

bool inDisc(int x, int y) { return (x - 40) * (x - 40) + (y - 20) * (y - 20) < 64; }

/// Waves in three colours; the other with less contrast, a chequered pattern and a disc. In [0,1].
Pair shownPair(int width, int height) {
  Pair pair{flat(width, height, glm::vec3(0)), flat(width, height, glm::vec3(0))};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 wave(.5 + .4 * std::sin(.21 * x + .13 * y), .5 + .4 * std::sin(.17 * x - .29 * y + 1),
                            .5 + .4 * std::cos(.0035 * x * y + .1 * y));
      const double chequer = .1 * ((x / 8 + y / 8) % 2);
      const glm::dvec3 disc = inDisc(x, y) ? glm::dvec3(.2, -.1, -.3) : glm::dvec3(0);
      pair.reference.at(x, y) = wave;
      pair.test.at(x, y) = glm::clamp(.9 * wave + .05 + chequer + disc, 0.0, 1.0);
    }
  return pair;
}

/// The same waves as exponents of radiance, with a sun 300 times as bright; the other with stripes and a disc.
Pair radiancePair(int width, int height) {
  Pair pair = shownPair(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double sun = (x - 12) * (x - 12) + (y - 12) * (y - 12) < 16 ? 300 : 1;
      const glm::dvec3 radiance = glm::exp(4.0 * glm::dvec3(pair.reference.at(x, y)) - 3.0) * sun;
      pair.reference.at(x, y) = radiance;
      pair.test.at(x, y) = radiance * (1 + .2 * std::sin(.5 * x)) + (inDisc(x, y) ? .3 : 0.0);
    }
  return pair;
}

double largest(const MetricMap& map) {
  double most = 0;
  for (const double v : map.plane.values) most = std::max(most, v);
  return most;
}

// scikit-image 0.19.3 and NumPy: structural_similarity(gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1) of
// .299 R + .587 G + .114 B; sqrt(mean((a - b)**2)).
TEST(ImageMetrics, RmsePsnrAndSsimAsOtherProgramsComputeThem) {
  const auto [reference, test] = shownPair(64, 48);
  EXPECT_NEAR(rootMeanSquareError(reference, test), .0915167, kFourDigits);
  EXPECT_NEAR(peakSignalToNoise(rootMeanSquareError(reference, test)), 20.76999, 1e-4);
  EXPECT_NEAR(meanOf(ssim(reference, test)), .8436959, kFourDigits);
}

// The formulas of the authors' Python program (flip_api.py of their public repository) in NumPy, with SciPy's two-dimensional correlate.
TEST(ImageMetrics, FlipAsTheAuthorsComputeIt) {
  const auto [reference, test] = shownPair(64, 48);
  const MetricMap map = ldrFlip(reference, test);
  EXPECT_NEAR(meanOf(map), .2951675, kFourDigits);
  EXPECT_NEAR(largest(map), .7664069, kFourDigits);
  EXPECT_NEAR(map.plane.at(40, 20), .5501403, kFourDigits);
  EXPECT_NEAR(map.plane.at(0, 0), .2276983, kFourDigits);
  const MetricMap far = ldrFlip(reference, test, {.pixelsPerDegree = 20});
  EXPECT_NEAR(meanOf(far), .3073006, kFourDigits);
  EXPECT_NEAR(largest(far), .8053180, kFourDigits);
}

TEST(ImageMetrics, HdrFlipAsTheAuthorsComputeIt) {
  const auto [reference, test] = radiancePair(64, 48);
  const HdrFlip result = hdrFlip(reference, test);
  EXPECT_NEAR(result.range.start, -6.9289065, kFourDigits);
  EXPECT_NEAR(result.range.stop, 2.0339967, kFourDigits);
  EXPECT_EQ(result.range.count, 9);
  EXPECT_NEAR(meanOf(result.map), .2198547, kFourDigits);
  EXPECT_NEAR(largest(result.map), .8413036, kFourDigits);
}

// Pictures of one colour have no edges: what is left is the remapped HyAB distance. Green and blue are the farthest apart by definition.
TEST(ImageMetrics, FlipOfFlatColours) {
  const auto between = [](glm::vec3 a, glm::vec3 b) { return meanOf(ldrFlip(flat(4, 4, a), flat(4, 4, b))); };
  EXPECT_NEAR(between(glm::vec3(0), glm::vec3(1)), .96738, kFourDigits);
  EXPECT_NEAR(between(glm::vec3(0), glm::vec3(.735357f)), .95854, kFourDigits);  // linear one half
  EXPECT_NEAR(between({1, 0, 0}, {0, 1, 0}), .98666, kFourDigits);
  EXPECT_NEAR(between({0, 1, 0}, {0, 0, 1}), 1.0, kFourDigits);
}

// (2 mu nu + C1) / (mu^2 + nu^2 + C1), as nothing varies.
TEST(ImageMetrics, SsimOfFlatGreys) {
  EXPECT_NEAR(meanOf(ssim(flat(20, 20, glm::vec3(.4f)), flat(20, 20, glm::vec3(.5f)))), (.4 + 1e-4) / (.41 + 1e-4), 1e-6);
}

TEST(ImageMetrics, AgreeWithThePlainVersion) {
  const Pair shown = shownPair(41, 33), radiance = radiancePair(41, 33);
  EXPECT_NEAR(meanOf(ssim(shown.reference, shown.test)), naive::ssim(shown.reference, shown.test), kSameFormula);
  for (const double pixelsPerDegree : {kPixelsPerDegree, 12.5}) {
    const auto expected = naive::flip(shown.reference, shown.test, pixelsPerDegree);
    const MetricMap map = ldrFlip(shown.reference, shown.test, {.pixelsPerDegree = pixelsPerDegree});
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(map.plane.values[i], expected[i], kSameFormula) << i;
  }
  const auto expected = naive::hdrFlip(radiance.reference, radiance.test, kPixelsPerDegree);
  const HdrFlip result = hdrFlip(radiance.reference, radiance.test);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(result.map.plane.values[i], expected[i], kSameFormula) << i;
}

TEST(ImageMetrics, EqualPicturesAreEqual) {
  for (const ImageRgb& image :
       {shownPair(30, 20).test, flat(1, 1, glm::vec3(.3f)), flat(7, 3, glm::vec3(0)), flat(1, 40, glm::vec3(1))}) {
    EXPECT_EQ(rootMeanSquareError(image, image), 0.0);
    EXPECT_EQ(peakSignalToNoise(rootMeanSquareError(image, image)), static_cast<double>(kInf));
    EXPECT_NEAR(meanOf(ssim(image, image)), 1.0, 1e-12);
    EXPECT_EQ(meanOf(ldrFlip(image, image)), 0.0);
    EXPECT_EQ(meanOf(hdrFlip(image, image).map), 0.0);
  }
}

TEST(ImageMetrics, OnePixelIsEnough) {
  const ImageRgb dark = flat(1, 1, glm::vec3(.2f)), light = flat(1, 1, glm::vec3(.8f));
  EXPECT_NEAR(meanOf(ldrFlip(dark, light)), meanOf(ldrFlip(flat(30, 30, glm::vec3(.2f)), flat(30, 30, glm::vec3(.8f)))), 1e-12);
  EXPECT_NEAR(meanOf(ssim(dark, light)), (2 * .16 + 1e-4) / (.04 + .64 + 1e-4), 1e-6);
  EXPECT_GT(meanOf(hdrFlip(dark, light).map), 0.0);
}

// The part of a border that a window misses is left out of the mean, but not where nothing else is there.
TEST(ImageMetrics, MeansLeaveCutWindowsOut) {
  const auto [reference, test] = shownPair(30, 20);
  const MetricMap map = ssim(reference, test);
  double sum = 0;
  for (int y = 5; y < 15; ++y)
    for (int x = 5; x < 25; ++x) sum += map.plane.at(x, y);
  EXPECT_NEAR(meanOf(map), sum / 200, 1e-12);
  PixelMask corner(600, 0);
  corner[0] = 1;
  EXPECT_EQ(meanOf(map, corner), map.plane.at(0, 0));
  EXPECT_TRUE(std::isnan(meanOf(map, PixelMask(600, 0))));
}

TEST(ImageMetrics, HdrFlipKnowsNoUnitOfRadiance) {
  const auto [reference, test] = radiancePair(40, 30);
  const auto scaled = [](ImageRgb image, float factor) {
    for (glm::vec3& texel : image.texels) texel *= factor;
    return image;
  };
  const double mean = meanOf(hdrFlip(reference, test).map);
  for (const float factor : {1e-20f, 1e-6f, 1e6f, 1e20f})
    EXPECT_NEAR(meanOf(hdrFlip(scaled(reference, factor), scaled(test, factor)).map), mean, 1e-5) << factor;
}

TEST(ImageMetrics, BlackReferences) {
  const ImageRgb black = flat(8, 8, glm::vec3(0));
  const HdrFlip both = hdrFlip(black, black);
  EXPECT_EQ(both.range.count, 1);
  EXPECT_EQ(meanOf(both.map), 0.0);
  EXPECT_GT(meanOf(hdrFlip(black, flat(8, 8, glm::vec3(1))).map), .5);
  ImageRgb lamp = black;  // the median is 0: the range ends after kMostStops
  lamp.texels[9] = glm::vec3(5);
  const HdrFlip one = hdrFlip(lamp, black);
  EXPECT_EQ(one.range.count, static_cast<int>(kMostStops));
  EXPECT_TRUE(meanOf(one.map) > 0.0 && meanOf(one.map) <= 1.0);
}

TEST(ImageMetrics, WhatIsNoNumberStaysWhereItIs) {
  const Pair shown = shownPair(40, 30), radiance = radiancePair(40, 30);
  for (const float bad : {kNan, kInf, -kInf}) {
    Pair broken = shown, brokenRadiance = radiance;
    broken.test.at(30, 15).g = bad;
    brokenRadiance.reference.at(30, 15).r = bad;
    EXPECT_TRUE(std::isnan(rootMeanSquareError(broken.reference, broken.test)));
    for (const MetricMap& map :
         {ssim(broken.reference, broken.test), ldrFlip(broken.reference, broken.test), ldrFlip(broken.test, broken.reference),
          hdrFlip(brokenRadiance.reference, brokenRadiance.test).map}) {
      EXPECT_TRUE(std::isnan(meanOf(map)));
      for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) EXPECT_EQ(std::isnan(map.plane.at(x, y)), x == 30 && y == 15);
      PixelMask rest(1200, 1);
      rest[15 * 40 + 30] = 0;
      EXPECT_TRUE(std::isfinite(meanOf(map, rest)));
    }
  }
}

TEST(ImageMetrics, NegativeRadianceIsBlack) {
  Pair negative = radiancePair(20, 20), black = negative;
  negative.test.at(5, 5) = glm::vec3(-3.0f);
  black.test.at(5, 5) = glm::vec3(0.0f);
  EXPECT_EQ(meanOf(hdrFlip(negative.reference, negative.test).map), meanOf(hdrFlip(black.reference, black.test).map));
  Pair outside = shownPair(20, 20), clamped = outside;
  outside.test.at(5, 5) = {-1, 2, .5f};
  clamped.test.at(5, 5) = {0, 1, .5f};
  EXPECT_EQ(meanOf(ldrFlip(outside.reference, outside.test)), meanOf(ldrFlip(clamped.reference, clamped.test)));
  EXPECT_EQ(meanOf(ssim(outside.reference, outside.test)), meanOf(ssim(clamped.reference, clamped.test)));
}

// max() over exposures must not lose a NaN, nor a bright spot overflow.
TEST(ImageMetrics, BrightestFloatIsOnlyBright) {
  Pair pair = radiancePair(20, 20);
  pair.test.at(3, 3) = glm::vec3(std::numeric_limits<float>::max());
  const MetricMap map = hdrFlip(pair.reference, pair.test).map;
  for (const double v : map.plane.values) EXPECT_TRUE(v >= 0.0 && v <= 1.0);
}

TEST(ImageMetrics, DifferentSizesAreRefused) {
  const ImageRgb a = flat(4, 4, glm::vec3(0)), b = flat(4, 5, glm::vec3(0)), none;
  for (const auto& [x, y] : {std::pair(a, b), std::pair(none, none)}) {
    EXPECT_THROW(rootMeanSquareError(x, y), Error);
    EXPECT_THROW(ssim(x, y), Error);
    EXPECT_THROW(ldrFlip(x, y), Error);
    EXPECT_THROW(hdrFlip(x, y), Error);
  }
  EXPECT_THROW(meanOf(ssim(a, a), PixelMask(3, 1)), Error);
}

TEST(ImageMetrics, SameForAnyThreadCount) {
  const auto [reference, test] = radiancePair(50, 70);
  EXPECT_EQ(hdrFlip(reference, test, {}, {.threads = 1}).map.plane.values,
            hdrFlip(reference, test, {}, {.threads = 3}).map.plane.values);
  EXPECT_EQ(ssim(reference, test, 1).plane.values, ssim(reference, test, 3).plane.values);
}

TEST(ImageMetrics, MagmaRunsFromBlackToPaleYellow) {
  EXPECT_EQ(magma(0), (std::array<std::uint8_t, 3>{0, 0, 4}));
  EXPECT_EQ(magma(1), (std::array<std::uint8_t, 3>{252, 253, 191}));
  EXPECT_EQ(magma(2), magma(1));
  EXPECT_EQ(magma(-1), magma(0));
  EXPECT_EQ(magma(static_cast<double>(kNan)), magma(0));
  double last = -1;  // lightness never falls
  for (int i = 0; i < 256; ++i) {
    const auto c = magma(i / 255.0);
    const double lightness = flip::huntLabFromLinear(glm::pow(glm::dvec3(c[0], c[1], c[2]) / 255.0, glm::dvec3(2.2))).x;
    EXPECT_GE(lightness, last - .5) << i;  // half a step of 100, by rounding to 8 bits
    last = lightness;
  }
}

}  // namespace
}  // namespace chiaro
