#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "assets/error.h"
#include "runtime/environment/cube_map.h"
#include "runtime/environment/prefilter.h"
#include "shaders/cpp/lobe.h"
#include "tests/runtime/environment_maps.h"

namespace chiaro {
namespace {

using namespace test;
constexpr double kPi = std::numbers::pi;

SgPyramid pyramidOf(const Environment& environment, int finestResolution, int threads = 0) {
  SgEnvironmentSettings settings;
  settings.finestResolution = finestResolution;
  settings.threads = threads;
  return prepareEnvironment(environment, settings).pyramid;
}

/// visit(level, direction, texel) for every texel of every level.
template <typename Visit>
void forEachTexel(const SgPyramid& pyramid, const Visit& visit) {
  for (int layer = 0; layer < 2; ++layer)
    for (const PrefilteredLevel& level : levelsOf(pyramid, layer)) {
      const int n = level.faceResolution;
      for (int i = 0; i < 6 * n * n; ++i)
        visit(level, glm::normalize(glm::dvec3(cubeTexelDirection(i / (n * n), i % n, i / n % n, n))),
              level.texels[static_cast<std::size_t>(i)]);
    }
}

TEST(BandFactors, AreTheVmfMoments) {
  for (double sharpness : {1e-3, 0.3, 1.0, 10.0, 777.0, 32768.0}) {
    const std::vector<double> rho = sgBandFactors(sharpness);
    EXPECT_DOUBLE_EQ(rho[0], 1.0);
    if (rho.size() > 1) {
      EXPECT_NEAR(rho[1], lobe64::vmfMeanCosine(sharpness), 1e-12);
    }
    for (std::size_t l = 1; l < rho.size(); ++l) EXPECT_LT(rho[l], rho[l - 1]);
  }
  const std::vector<double> ten = sgBandFactors(10.0);
  EXPECT_NEAR(ten[2], 0.7300, 5e-5);  // as tabulated in the literature to four places
  EXPECT_NEAR(ten[4], 0.3555, 5e-5);
  EXPECT_EQ(sgBandFactors(0.0).size(), 1u);
}

TEST(Pyramid, FollowsTheMipRule) {
  const SgPyramid pyramid = pyramidOf(constantEnvironment(64, 32, glm::vec3(1.0f)), 64);
  EXPECT_EQ(pyramid.finestResolution, 64);
  EXPECT_EQ(pyramid.finestSharpness, 128.0f);
  ASSERT_EQ(pyramid.layer0.size(), 5u);
  ASSERT_EQ(pyramid.layer1.size(), 5u);
  for (std::size_t m = 0; m < 5; ++m) {
    EXPECT_EQ(pyramid.layer0[m].sharpness, 128.0f / std::pow(4.0f, static_cast<float>(m)));
    EXPECT_EQ(pyramid.layer1[m].sharpness, 64.0f / std::pow(4.0f, static_cast<float>(m)));
    for (int layer = 0; layer < 2; ++layer) {
      const PrefilteredLevel& level = levelsOf(pyramid, layer)[m];
      EXPECT_EQ(level.faceResolution, 64 >> m);
      EXPECT_EQ(level.texels.size(), static_cast<std::size_t>(6 * level.faceResolution * level.faceResolution));
    }
  }
  EXPECT_LE(pyramid.layer0.back().sharpness, 0.5f);
}

TEST(Pyramid, ConstantStaysConstant) {
  const glm::vec3 value(0.25f, 1.0f, 3000.0f);
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {2, 1}, {5, 3}, {100, 37}, {256, 128}, {512, 700}}) {
    const Environment environment = constantEnvironment(size.x, size.y, value);
    SgEnvironmentSettings settings;
    settings.finestResolution = 64;
    const SgEnvironment prepared = prepareEnvironment(environment, settings);
    EXPECT_TRUE(prepared.lights.empty()) << size.x << 'x' << size.y;
    float worst = 0.0f;
    forEachTexel(prepared.pyramid, [&](const PrefilteredLevel&, const glm::dvec3&, const glm::vec3& texel) {
      const glm::vec3 error = glm::abs(texel / value - 1.0f);
      for (int c = 0; c < 3; ++c) worst = error[c] <= worst ? worst : error[c];
    });
    EXPECT_LE(worst, 1e-5f) << size.x << 'x' << size.y;  // float storage; the sums are double
  }
}

TEST(Pyramid, AgreesWithPlainSummation) {
  const Environment environment = noisyEnvironment(96, 48, 7);
  const SgPyramid pyramid = pyramidOf(environment, 128);
  std::mt19937 random(11);
  double worst = 0.0;
  for (int layer = 0; layer < 2; ++layer)
    for (const PrefilteredLevel& level : levelsOf(pyramid, layer)) {
      const int n = level.faceResolution;
      float brightest = 0.0f;
      for (const glm::vec3& texel : level.texels) brightest = std::max(brightest, texel.y);
      for (int k = 0; k < 12; ++k) {
        const int i = static_cast<int>(random() % static_cast<unsigned>(6 * n * n));
        const glm::dvec3 direction = glm::normalize(glm::dvec3(cubeTexelDirection(i / (n * n), i % n, i / n % n, n)));
        const glm::dvec3 expected = sumUnderKernel(environment.radiance, direction, static_cast<double>(level.sharpness), 8);
        const double error =
            glm::length(glm::dvec3(level.texels[static_cast<std::size_t>(i)]) - expected) / static_cast<double>(brightest);
        worst = error <= worst ? worst : error;
        // Texels halved twice instead of interpolated exactly between rows (3e-3 at texels as wide as the finest kernel), cubic lookup 4e-4.
        EXPECT_LE(error, 4e-3) << "sharpness " << level.sharpness;
      }
    }
  RecordProperty("worst", std::to_string(worst));
  std::printf("worst difference from plain summation: %.1e of the level's brightest value\n", worst);
}

TEST(Pyramid, SgEnvironmentGivesTheInnerProduct) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.8, -0.4));
  constexpr double kSharpness = 40.0;
  const auto source = lobe64::sphericalGaussian(axis, kSharpness, 2.5);
  const Environment environment =
      makeEnvironment(512, 256, 1, [&](const glm::dvec3& w) { return glm::dvec3(lobe64::sgEvaluate(source, w)); });
  const SgPyramid pyramid = pyramidOf(environment, 128);
  forEachTexel(pyramid, [&](const PrefilteredLevel& level, const glm::dvec3& w, const glm::vec3& texel) {
    const double kernel = level.sharpness;
    const double expected = lobe64::sgInnerProduct(source, lobe64::sphericalGaussian(w, kernel, lobe64::vmfAmplitude(kernel)));
    const double peak = lobe64::sgInnerProduct(source, lobe64::sphericalGaussian(axis, kernel, lobe64::vmfAmplitude(kernel)));
    // Interpolating the source between texels 0.0123 rad apart widens it by 40 * 0.0123^2 / 6 = 0.1 %; cubic lookup 4e-4.
    ASSERT_LE(std::abs(texel.y - expected), 2e-3 * peak) << "sharpness " << kernel;
  });
}

TEST(Pyramid, SingleTexelGivesTheKernel) {
  for (const glm::ivec2 at : {glm::ivec2(300, 256), {77, 100}, {1000, 30}}) {
    Environment environment = constantEnvironment(1024, 512, glm::vec3(0.0f));
    environment.radiance.at(at.x, at.y) = glm::vec3(1e5f);
    const double flux = 1e5 * texelSolidAngle(environment.radiance, at.y);
    const glm::dvec3 direction = lobe64::directionFromEquirect({(at.x + 0.5) / 1024, (at.y + 0.5) / 512});
    const SgPyramid pyramid = pyramidOf(environment, 256);
    forEachTexel(pyramid, [&](const PrefilteredLevel& level, const glm::dvec3& w, const glm::vec3& texel) {
      const double kernel = level.sharpness;
      const double peak = flux * lobe64::vmfAmplitude(kernel);
      const double expected = peak * std::exp(-0.5 * kernel * glm::dot(w - direction, w - direction));
      // Linear interpolation spreads the texel by variance 0.00614^2 / 6: 1.3 % at the finest sharpness, 2048, less at others.
      ASSERT_LE(std::abs(texel.y - expected), (2e-3 + 8e-6 * kernel) * peak) << "sharpness " << kernel;
    });
  }
}

TEST(Pyramid, KeepsTheEnergyOfEveryLevel) {
  for (const Environment& environment :
       {noisyEnvironment(200, 77, 1), noisyEnvironment(256, 128, 2), noisyEnvironment(700, 400, 3), windowedRoom(256)}) {
    const glm::dvec3 expected = fluxOf(environment.radiance);
    const SgPyramid pyramid = pyramidOf(environment, 64);
    for (int layer = 0; layer < 2; ++layer)
      for (const PrefilteredLevel& level : levelsOf(pyramid, layer)) {
        const int n = level.faceResolution;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 6 * n * n; ++i)
          sum += cubeTexelSolidAngle(i % n, i / n % n, n) * glm::dvec3(level.texels[static_cast<std::size_t>(i)]);
        // The sum itself, texel centres for texel means, is good to 1e-3 at 6 sqrt(sharpness) texels a face.
        for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(sum[c] / expected[c] - 1.0), 1e-3) << "sharpness " << level.sharpness;
      }
  }
}

TEST(Pyramid, IsLinear) {
  const Environment a = noisyEnvironment(128, 64, 1), b = windowedRoom(128);
  Environment mix = a;
  for (std::size_t i = 0; i < mix.radiance.texels.size(); ++i)
    mix.radiance.texels[i] = 2.0f * a.radiance.texels[i] + 0.5f * b.radiance.texels[i];
  const SgPyramid pa = pyramidOf(a, 64), pb = pyramidOf(b, 64), pm = pyramidOf(mix, 64);
  for (int layer = 0; layer < 2; ++layer)
    for (std::size_t m = 0; m < pm.layer0.size(); ++m)
      for (std::size_t i = 0; i < levelsOf(pm, layer)[m].texels.size(); ++i) {
        const glm::vec3 sum = 2.0f * levelsOf(pa, layer)[m].texels[i] + 0.5f * levelsOf(pb, layer)[m].texels[i];
        ASSERT_LE(glm::length(levelsOf(pm, layer)[m].texels[i] - sum),
                  1e-4f * (1.0f + glm::length(sum)));  // float rounding of bright texels
      }
}

TEST(Pyramid, QuarterTurnTurnsTheFaces) {
  const Environment environment = noisyEnvironment(128, 64, 4);
  Environment turned = environment;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) turned.radiance.at((x + 32) % 128, y) = environment.radiance.at(x, y);
  const SgPyramid before = pyramidOf(environment, 64), after = pyramidOf(turned, 64);
  std::mt19937 random(9);
  for (int k = 0; k < 2000; ++k) {
    const glm::vec3 w = lobe32::directionFromEquirect(
        {static_cast<float>(random() % 9973) / 9973.0f, static_cast<float>(random() % 9967) / 9967.0f});
    const glm::vec3 there(-w.z, w.y, w.x);  // -Z, the image's centre, goes to +X, a quarter to its right
    const float sharpness = std::exp2(static_cast<float>(random() % 80) / 10.0f - 1.0f);
    const glm::vec3 expected = samplePyramid(before, w, sharpness);
    EXPECT_LE(glm::length(samplePyramid(after, there, sharpness) - expected), 2e-3f * glm::length(expected));  // lookup rounding
  }
}

/// The grid underneath has poles; a lobe must look the same on one as anywhere else.
TEST(Pyramid, PolesAreNotSpecial) {
  const glm::dvec3 axes[] = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, glm::normalize(glm::dvec3(0.02, 1.0, 0.01))};
  for (const glm::dvec3& axis : axes) {
    const auto source = lobe64::sphericalGaussian(axis, 300.0, 1.0);
    const Environment environment =
        makeEnvironment(1024, 512, 1, [&](const glm::dvec3& w) { return glm::dvec3(lobe64::sgEvaluate(source, w)); });
    const SgPyramid pyramid = pyramidOf(environment, 256);
    forEachTexel(pyramid, [&](const PrefilteredLevel& level, const glm::dvec3& w, const glm::vec3& texel) {
      const double kernel = level.sharpness;
      const auto expected = [&](const glm::dvec3& d) {
        return lobe64::sgInnerProduct(source, lobe64::sphericalGaussian(d, kernel, lobe64::vmfAmplitude(kernel)));
      };
      ASSERT_LE(std::abs(texel.y - expected(w)), 3e-3 * expected(axis))
          << "sharpness " << kernel;  // interpolated source .2 %, lookup 4e-4
    });
  }
}

TEST(Pyramid, SampleInterpolatesAndClamps) {
  const Environment environment = windowedRoom(128);
  const SgPyramid pyramid = pyramidOf(environment, 64);
  const glm::vec3 w = glm::normalize(glm::vec3(0.2f, 0.3f, -0.9f));
  const auto at = [&](float sharpness) { return samplePyramid(pyramid, w, sharpness).y; };
  const auto level = [&](const PrefilteredLevel& l) { return sampleCube(l.texels, l.faceResolution, w).y; };
  EXPECT_EQ(at(128.0f), level(pyramid.layer0[0]));
  EXPECT_EQ(at(64.0f), level(pyramid.layer1[0]));
  EXPECT_EQ(at(32.0f), level(pyramid.layer0[1]));
  EXPECT_NEAR(at(64.0f * std::sqrt(2.0f)), 0.5f * (at(128.0f) + at(64.0f)), 1e-4f * at(64.0f));
  EXPECT_EQ(at(1e6f), at(128.0f));
  EXPECT_EQ(at(0.0f), at(pyramid.layer1.back().sharpness));
  EXPECT_NEAR(unfilteredSharpness(1024) * 4, unfilteredSharpness(2048), 1.0f);
}

TEST(Pyramid, SameForAnyThreadCount) {
  const Environment environment = windowedRoom(256);
  SgEnvironmentSettings settings;
  settings.finestResolution = 128;
  settings.threads = 1;
  const SgEnvironment one = prepareEnvironment(environment, settings);
  for (int threads : {2, 3, 8}) {
    settings.threads = threads;
    const SgEnvironment many = prepareEnvironment(environment, settings);
    for (int layer = 0; layer < 2; ++layer)
      for (std::size_t m = 0; m < one.pyramid.layer0.size(); ++m)
        EXPECT_TRUE(levelsOf(one.pyramid, layer)[m].texels == levelsOf(many.pyramid, layer)[m].texels);
    ASSERT_EQ(one.lights.size(), many.lights.size());
    for (std::size_t k = 0; k < one.lights.size(); ++k) {
      EXPECT_EQ(one.lights[k].axis, many.lights[k].axis);
      EXPECT_EQ(one.lights[k].sharpness, many.lights[k].sharpness);
      EXPECT_EQ(one.lights[k].amplitude, many.lights[k].amplitude);
    }
  }
}

TEST(Pyramid, NeverNegativeBesideASun) {
  const Environment environment = discOnSky(512, {0.4, 0.7, 0.3}, 0.01, 100.0);
  forEachTexel(pyramidOf(environment, 256), [&](const PrefilteredLevel& level, const glm::dvec3&, const glm::vec3& texel) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_GE(texel[c], 0.15f) << "sharpness "
                                 << level.sharpness;  // the sky alone is 0.2 at its darkest; ripple 1e-7 of a sun of 3e4
      ASSERT_LE(texel[c], 1e6f);
    }
  });
}

TEST(Prepare, RefusesBadInput) {
  const auto codeOf = [](Environment environment, SgEnvironmentSettings settings) {
    try {
      prepareEnvironment(environment, settings);
    } catch (const Error& error) {
      return error.code();
    }
    return ExitCode::done;
  };
  const Environment good = constantEnvironment(8, 4, glm::vec3(1.0f));
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f}) {
    Environment broken = good;
    broken.radiance.texels[9].y = bad;
    EXPECT_EQ(codeOf(broken, {}), ExitCode::unreadableInput);
  }
  EXPECT_EQ(codeOf({}, {}), ExitCode::unreadableInput);
  Environment cut = good;
  cut.radiance.texels.pop_back();
  EXPECT_EQ(codeOf(cut, {}), ExitCode::unreadableInput);
  for (int resolution : {0, 8, 100, 2048, -64}) {
    SgEnvironmentSettings settings;
    settings.finestResolution = resolution;
    EXPECT_EQ(codeOf(good, settings), ExitCode::usage) << resolution;
  }
  SgEnvironmentSettings crossed;
  crossed.minLightSharpness = 100.0f;
  crossed.maxLightSharpness = 50.0f;
  EXPECT_EQ(codeOf(good, crossed), ExitCode::usage);
}

TEST(Prepare, BlackIsBlack) {
  SgEnvironmentSettings settings;
  settings.finestResolution = 16;
  const SgEnvironment black = prepareEnvironment(constantEnvironment(16, 8, glm::vec3(0.0f)), settings);
  EXPECT_TRUE(black.lights.empty());
  forEachTexel(black.pyramid,
               [](const PrefilteredLevel&, const glm::dvec3&, const glm::vec3& texel) { EXPECT_EQ(texel, glm::vec3(0.0f)); });
}

}  // namespace
}  // namespace chiaro
