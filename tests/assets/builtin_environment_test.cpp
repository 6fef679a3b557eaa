#include "assets/builtin/environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/error.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr double kPi = std::numbers::pi;


/// Sum over texels of weight(direction) * luminance * solid angle.
template <class Weight>
double integrate(const ImageRgb& image, Weight weight) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double solidAngle =
        2.0 * kPi / image.width * (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 w = lobe64::directionFromEquirect(glm::dvec2((x + 0.5) / image.width, (y + 0.5) / image.height));
      sum += weight(w) * luminance(glm::dvec3(image.at(x, y))) * solidAngle;
    }
  }
  return sum;
}

TEST(BuiltinEnvironment, AllAreFiniteAndTwiceAsWideAsHigh) {
  for (const std::string& name : builtinEnvironmentNames()) {
    const Environment environment = loadEnvironment(name);
    EXPECT_EQ(environment.name, name);
    EXPECT_EQ(environment.radiance.width, 2 * environment.radiance.height);
    std::size_t bad = 0;
    for (const glm::vec3& texel : environment.radiance.texels) {
      if (!(texel.x >= 0.0f && texel.y >= 0.0f && texel.z >= 0.0f && texel.x + texel.y + texel.z < 1e6f)) ++bad;
    }
    EXPECT_EQ(bad, 0u) << name;
  }
}

TEST(BuiltinEnvironment, UnknownNamesAndMissingFilesAreErrors) {
  EXPECT_THROW(loadEnvironment("dusk"), Error);
  EXPECT_THROW(loadEnvironment("no_such_file.hdr"), Error);
}

TEST(BuiltinEnvironment, TheSunGivesFourTimesTheSkysIrradiance) {
  const ImageRgb image = loadEnvironment("sunny").radiance;
  // The sun is the brightest texel's neighbourhood; its disc has a radius of 1 degree, so that 1.7 degrees hold it with its soft edge.
  glm::dvec3 sun(0.0);
  double brightest = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (luminance(glm::dvec3(image.at(x, y))) > brightest) {
        brightest = luminance(glm::dvec3(image.at(x, y)));
        sun = lobe64::directionFromEquirect(glm::dvec2((x + 0.5) / image.width, (y + 0.5) / image.height));
      }
    }
  }
  // The disc spans 5.7 texels and is flat: refine to the middle of its own light.
  glm::dvec3 middle(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = integrate(image, [&](glm::dvec3 w) { return glm::dot(w, sun) > std::cos(0.045) ? w[axis] : 0.0; });
  }
  sun = glm::normalize(middle);
  const double nearSun = std::cos(1.7 * kPi / 180.0);
  const double sunIrradiance =
      integrate(image, [&](glm::dvec3 w) { return glm::dot(w, sun) > nearSun ? glm::dot(w, sun) : 0.0; });
  const double skyIrradiance =
      integrate(image, [&](glm::dvec3 w) { return glm::dot(w, sun) > nearSun ? 0.0 : std::max(w.y, 0.0); });
  // 3 %: the aureole within 1.7 degrees counts for the sun, and the disc's edge is sampled on 8 x 8 points a texel.
  EXPECT_NEAR(sunIrradiance / skyIrradiance, 4.0, 0.12);
  EXPECT_GT(sun.y, 0.5);
}

TEST(BuiltinEnvironment, OvercastIsTheCieSky) {
  const ImageRgb image = loadEnvironment("overcast").radiance;
  const double zenith = luminance(glm::dvec3(image.at(0, 0)));
  // Moon and Spencer's sky gives 7 pi / 9 of the zenith's radiance on the ground; the midpoint rule on 256 rows is good to 1e-4.
  EXPECT_NEAR(integrate(image, [](glm::dvec3 w) { return std::max(w.y, 0.0); }) / zenith, 7.0 * kPi / 9.0, 1e-3);
}

TEST(BuiltinEnvironment, TheWindowsAreSmallAndGiveMostOfTheLight) {
  const ImageRgb image = loadEnvironment("windows").radiance;
  const double all = integrate(image, [](glm::dvec3) { return 1.0; });
  double bright = 0.0;
  double share = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double solidAngle =
        2.0 * kPi / image.width * (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
    for (int x = 0; x < image.width; ++x) {
      const double value = luminance(glm::dvec3(image.at(x, y)));
      if (!(value > 5.0)) continue;
      bright += value * solidAngle;
      share += solidAngle / (4.0 * kPi);
    }
  }
  EXPECT_LT(share, 0.03);
  EXPECT_GT(share, 0.001);
  EXPECT_GT(bright / all, 0.6);
}

TEST(AutoExposure, ShowsAWhiteBallAtHalf) {
  // White: the irradiance is pi whatever the normal.
  EXPECT_NEAR(autoExposure(loadEnvironment("white")), 0.5f, 1e-6f);
  Environment environment{"twice", ImageRgb{8, 4, std::vector<glm::vec3>(32, glm::vec3(2.0f))}};
  EXPECT_NEAR(autoExposure(environment), 0.25f, 1e-6f);
  // Only the upper half: half of the light.
  for (int y = 2; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) environment.radiance.at(x, y) = glm::vec3(0.0f);
  }
  EXPECT_NEAR(autoExposure(environment), 0.5f, 1e-6f);
  // What the least .hdr texel with a mantissa of a half holds, 80 80 80 01: the inverse is above the largest float.
  std::ranges::fill(environment.radiance.texels, glm::vec3(std::ldexp(1.0f, -128)));
  EXPECT_EQ(autoExposure(environment), 1e12f);
  std::ranges::fill(environment.radiance.texels, glm::vec3(0.0f));
  EXPECT_EQ(autoExposure(environment), 1.0f);
}

}  // namespace
}  // namespace chiaro
