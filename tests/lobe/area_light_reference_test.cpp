// shaders/lobe/area_light.glsl against quadrature over the light's own surface or cap, and its limits.

#include <gtest/gtest.h>

#include <cmath>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using quadrature::kPi;

glm::dvec3 tilted(double angle) { return {std::sin(angle), 0.0, std::cos(angle)}; }

/// Integral of f over a cap of half-angle s about +Z.
template <class F>
double overCap(double s, F f) {
  return quadrature::integrate(
      [&](double theta) {
        double sum = 0;
        constexpr int kTurns = 720;
        for (int k = 0; k < kTurns; ++k) {
          const double phi = 2 * kPi * (k + 0.5) / kTurns;
          sum += f(glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
        }
        return std::sin(theta) * sum * 2 * kPi / kTurns;
      },
      0.0, s, 8);
}

/// Vector irradiance of a disk of radiance 1 at the origin that faces +Z, at a point.
glm::dvec3 diskVectorIrradiance(double radius, glm::dvec3 point) {
  glm::dvec3 sum(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    sum[axis] = quadrature::integrate(
        [&](double r) {
          double ring = 0;
          constexpr int kTurns = 1440;
          for (int k = 0; k < kTurns; ++k) {
            const double phi = 2 * kPi * (k + 0.5) / kTurns;
            const glm::dvec3 way = glm::dvec3(r * std::cos(phi), r * std::sin(phi), 0.0) - point;
            const double d2 = glm::dot(way, way);
            ring += (-way.z / std::sqrt(d2)) / d2 * way[axis] / std::sqrt(d2);
          }
          return r * ring * 2 * kPi / kTurns;
        },
        0.0, radius, 40);
  }
  return sum;
}

TEST(AreaLight, ASphereLightsAsAPointAndFluxIsItsSolidAngle) {
  for (const double radius : {0.0, 1e-6, 0.3, 1.0, 1.99}) {
    const lobe64::LightCap cap = lobe64::sphereCap(glm::dvec3(0, 2, 0), radius);
    EXPECT_NEAR(cap.irradiance, 0.25, 1e-15);
    EXPECT_NEAR(cap.sinSquared, radius * radius / 4, 1e-15);
    if (radius < 0.01) continue;
    const double radiance = 1 / (kPi * radius * radius), s = std::asin(radius / 2);
    EXPECT_NEAR(cap.irradiance, kPi * radiance * std::sin(s) * std::sin(s), 1e-12);
    EXPECT_NEAR(cap.flux / (2 * kPi * radiance * (1 - std::cos(s))), 1.0, 1e-12);
  }
  const lobe64::LightCap inside = lobe64::sphereCap(glm::dvec3(0.1, 0, 0), 0.5);
  EXPECT_NEAR(inside.irradiance, 4.0, 1e-12);
  EXPECT_NEAR(inside.flux, 16.0, 1e-12);
  EXPECT_EQ(lobe64::capIrradianceShare(inside, -1.0), 1.0);
}

TEST(AreaLight, IrradianceOfACapCutByTheHorizonByQuadrature) {
  for (const double s : {1e-4, 0.02, 0.3, 1.0, 1.5}) {
    const lobe64::LightCap cap = lobe64::sunCap(glm::dvec3(0, 0, 1), s);
    for (double angle = 0.0; angle < 3.1; angle += 0.0913) {
      // Where the cap is cut, at an angle that the loop's steps would miss for small caps.
      for (const double at : {angle, 0.5 * kPi + s * std::cos(3.0 * angle)}) {
        const glm::dvec3 n = tilted(at);
        const double expected = overCap(s, [&](const glm::dvec3& w) { return std::max(glm::dot(n, w), 0.0); }) / (kPi * std::sin(s) * std::sin(s));
        // The quadrature's own kink at the horizon: 1e-5 of the light's width.
        EXPECT_NEAR(lobe64::capIrradianceShare(cap, std::cos(at)), expected, 1e-4 * std::min(s, 1.0)) << s << " " << at;
      }
    }
  }
}

TEST(AreaLight, TheVectorIrradianceOfADiskByQuadrature) {
  for (const double radius : {0.05, 0.7, 3.0}) {
    for (const glm::dvec3& point : {glm::dvec3(0, 0, 1), glm::dvec3(0.5, 0, 0.4), glm::dvec3(2, 1, 0.3), glm::dvec3(-1, 4, 2)}) {
      const lobe64::LightCap cap = lobe64::diskCap(-point, glm::dvec3(0, 0, 1), radius);
      const glm::dvec3 expected = diskVectorIrradiance(radius, point) / (kPi * radius * radius);
      EXPECT_LE(glm::length(cap.axis * cap.irradiance - expected), 2e-6 * glm::length(expected)) << radius << " " << point.x << " " << point.z;
      EXPECT_NEAR(cap.sinSquared, radius * radius * cap.irradiance, 1e-12);
    }
  }
  EXPECT_EQ(lobe64::diskCap(glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1), 1.0).irradiance, 0.0) << "behind it";
  // Lambert's point: cosine over squared distance.
  const lobe64::LightCap point = lobe64::diskCap(glm::dvec3(-1, 0, -1), glm::dvec3(0, 0, 1), 0.0);
  EXPECT_NEAR(point.irradiance, 0.5 * std::sqrt(0.5), 1e-12);
  EXPECT_LE(glm::length(point.axis - glm::normalize(glm::dvec3(-1, 0, -1))), 1e-12);
}

// The closed forms of radiometry: a sphere pi L sin^2 s cos, a disk on its axis pi L r^2 / (r^2 + h^2).
TEST(AreaLight, ClosedForms) {
  const lobe64::LightCap sphere = lobe64::sphereCap(glm::dvec3(0, 0, 3), 1.0);
  EXPECT_NEAR(sphere.irradiance * lobe64::capIrradianceShare(sphere, std::cos(0.7)), std::cos(0.7) / 9.0, 1e-14);
  for (const double h : {1e-3, 0.2, 1.0, 50.0}) {
    const lobe64::LightCap disk = lobe64::diskCap(glm::dvec3(0, 0, h), glm::dvec3(0, 0, -1), 2.0);
    EXPECT_NEAR(disk.irradiance * (4.0 + h * h), 1.0, 1e-9) << h;
  }
}

TEST(AreaLight, TheGaussianKeepsFluxAndMeanCosine) {
  for (const double s : {1e-5, 0.01, 0.4, 1.2, 0.5 * kPi}) {
    const lobe64::LightCap cap = lobe64::sunCap(glm::dvec3(0, 0, 1), s);
    const double sharpness = lobe64::capSharpness(cap);
    EXPECT_NEAR(lobe64::oneMinusMeanCosine(sharpness) / (std::sin(0.5 * s) * std::sin(0.5 * s)), 1.0, 1e-6) << s;
    if (s < 0.02) {
      EXPECT_NEAR(sharpness * s * s, 4.0, 1e-3);
    }
  }
}

TEST(AreaLight, TheMeanUnderALobeByQuadrature) {
  double worst = 0, worstLarge = 0;
  for (const double s : {0.003, 0.05, 0.2, 0.5, 1.0, 0.5 * kPi}) {
    const lobe64::LightCap cap = lobe64::sunCap(glm::dvec3(0, 0, 1), s);
    for (const double l : {10.0, 50.0, 300.0, 3000.0}) {
      const double toShare = kPi * std::sin(s) * std::sin(s);
      const auto truth = [&](double angle) { return quadrature::lobeAboutPole(l, angle, 0, s, [](double) { return 1.0; }) * lobe64::vmfAmplitude(l); };
      const double peak = truth(0.0);
      for (double angle = 0.0; angle < 3.1; angle += 0.02) {
        const double error = std::abs(lobe64::capMeanUnderLobe(cap, tilted(angle), l) * toShare - truth(angle)) / peak;
        (s > 0.6 ? worstLarge : worst) = std::max(s > 0.6 ? worstLarge : worst, error);
      }
    }
  }
  std::printf("share of a lobe in a cap: %.4f of the peak up to .5 rad, %.4f up to pi/2\n", worst, worstLarge);
  EXPECT_LE(worst, 0.011);
  EXPECT_LE(worstLarge, 0.055);
}

TEST(AreaLight, AVerySmallCapIsAPoint) {
  for (const double s : {0.0, 1e-12, 1e-6}) {
    const lobe64::LightCap cap = lobe64::sunCap(glm::dvec3(0, 0, 1), s);
    for (const double l : {0.0, 1.0, 40.0, 1e4})
      for (const double angle : {0.0, 0.01, 0.3}) {
        const glm::dvec3 axis = tilted(angle);
        const double density = lobe64::sgEvaluate(lobe64::sphericalGaussian(axis, l, lobe64::vmfAmplitude(l)), glm::dvec3(0, 0, 1));
        EXPECT_NEAR(lobe64::capMeanUnderLobe(cap, axis, l), density, 1e-7 * (density + 1e-12 * lobe64::vmfAmplitude(l))) << s << " " << l << " " << angle;
      }
    EXPECT_EQ(lobe64::capThroughLobes(cap, 1e-4), 0.0);
  }
}

TEST(AreaLight, SevenPointsKeepTheFirstMoment) {
  const lobe64::LightCap cap = lobe64::sunCap(glm::dvec3(0, 0, 1), 0.9);
  glm::dvec3 sum(0.0);
  double weight = 0;
  for (int i = 0; i < lobe64::kCapPoints; ++i) {
    const glm::dvec3 w = lobe64::capPoint(cap, glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), i);
    EXPECT_NEAR(glm::length(w), 1.0, 1e-9);
    sum += lobe64::capPointWeight(i) * w;
    weight += lobe64::capPointWeight(i);
  }
  EXPECT_NEAR(weight, 1.0, 1e-15);
  EXPECT_LE(glm::length(sum - glm::dvec3(0, 0, 0.5 * (1 + std::cos(0.9)))), 1e-9);
}

// Sizes, distances and lobes at their extremes, in float: finite, not negative, shares at most 1.
template <class Cap, class Share, class Mean, class Sharpness>
void expectSane(const Cap& cap, Share share, Mean mean, Sharpness sharpness) {
  EXPECT_TRUE(std::isfinite(cap.irradiance) && cap.irradiance >= 0.0f) << cap.irradiance;
  EXPECT_TRUE(std::isfinite(1e6f * cap.flux) && cap.flux >= 0.0f) << cap.flux;
  EXPECT_TRUE(cap.sinSquared >= 0.0f && cap.sinSquared <= 1.0f) << cap.sinSquared;
  EXPECT_TRUE(sharpness() >= 0.0f);
  for (const float c : {-1.0f, -1e-4f, 0.0f, 1e-4f, 1.0f}) EXPECT_TRUE(share(c) >= 0.0f && share(c) <= 1.0f) << c;
  for (const float l : {0.0f, 1e-3f, 30.0f, 1e8f, 1e30f})
    for (const glm::vec3& axis : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(0.6f, 0, 0.8f)})
      EXPECT_TRUE(std::isfinite(mean(axis, l)) && mean(axis, l) >= 0.0f) << l << " " << mean(axis, l);
}

TEST(AreaLight, ExtremesStayFinite) {
  using namespace lobe32;
  for (const float radius : {0.0f, 1e-20f, 1e-6f, 1.0f, 1e6f})
    for (const float distance : {0.0f, 1e-30f, 1e-6f, 1.0f, 1e6f, 1e18f})
      for (const glm::vec3& way : {glm::vec3(0, 0, 1), glm::vec3(1, 0, 0), glm::vec3(0.6f, 0, -0.8f)})
        for (const LightCap& cap : {sphereCap(distance * way, radius), diskCap(distance * way, glm::vec3(0, 0, -1), radius)})
          expectSane(cap, [&](float c) { return capIrradianceShare(cap, c); }, [&](glm::vec3 a, float l) { return capMeanUnderLobe(cap, a, l); },
                     [&] { return capSharpness(cap); });
}

}  // namespace
}  // namespace chiaro
