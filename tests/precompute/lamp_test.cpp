// The reference's lights that have a size: their estimators against closed forms, and against each other.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "precompute/reference/direct_light.h"
#include "precompute/reference/lamp_sampler.h"

namespace chiaro {
namespace {

using namespace reference;

constexpr double kPi = std::numbers::pi;

Surface lambert(glm::dvec3 normal) {
  Surface surface;
  surface.geometricNormal = surface.interpolatedNormal = normal;
  const glm::dvec3 axis = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(axis, normal));
  surface.worldFromTangent = glm::dmat3(tangent, glm::cross(normal, tangent), normal);
  surface.brdf = {glm::dvec3(1.0), glm::dvec3(0.0), glm::dvec3(0.0), 0.5, 0.5};
  return surface;
}

Light sphere(glm::vec3 position, float radius) {
  Light light;
  light.type = LightType::sphere;
  light.position = position;
  light.radius = radius;
  light.intensity = 3.0f;
  return light;
}

Light disk(glm::vec3 position, glm::vec3 direction, float radius) {
  Light light = sphere(position, radius);
  light.type = LightType::disk;
  light.direction = direction;
  light.innerConeAngle = 1.5706f;  // no cone
  light.outerConeAngle = 1.5707963f;
  return light;
}

Light sun(glm::vec3 direction, float angle) {
  Light light;
  light.direction = direction;
  light.angle = angle;
  light.intensity = 3.0f;
  return light;
}

/// Irradiance of a surface at the origin.
void expectIrradiance(const Light& light, glm::dvec3 normal, double expected, Strategy strategy = Strategy::combined) {
  const Surface surface = lambert(normal);
  const Estimate estimate = lampLight(surface, normal, {light}, nullptr, 1 << 15, 7, strategy);
  const double sigma = kPi * std::sqrt(estimate.varianceOfMean.x);
  EXPECT_LE(sigma, 0.01 * expected);
  // 1e-4: what the BRDF's directions would add where they hit a small light less than once in all their number, so that no variance shows.
  EXPECT_NEAR(kPi * estimate.mean.x, expected, 5.0 * sigma + 1e-4 * expected);
}

TEST(ReferenceLamp, IrradianceIsTheClosedForm) {
  const glm::dvec3 up(0, 1, 0), tilted(std::sin(0.6), std::cos(0.6), 0);
  for (const float radius : {0.0f, 1e-9f, 1e-4f, 0.1f, 1.0f}) {
    expectIrradiance(sphere({0, 2, 0}, radius), up, 3.0 / 4.0);                        // pi L sin^2 s
    expectIrradiance(sphere({0, 2, 0}, radius), tilted, 3.0 / 4.0 * std::cos(0.6));
    expectIrradiance(disk({0, 2, 0}, {0, -1, 0}, radius), up, 3.0 / (4.0 + std::pow(double(radius), 2.0)));  // pi L r^2 / (r^2 + h^2)
  }
  // Half of a sphere below the horizon: L (s - sin s cos s), the projected area of half a disc seen edge on.
  const double s = std::asin(0.5), radiance = 3.0 / kPi;
  expectIrradiance(sphere({2, 0, 0}, 1.0f), up, radiance * (s - std::sin(s) * std::cos(s)));
  for (const float angle : {0.0f, 0.004f, 0.3f}) expectIrradiance(sun({0, -1, 0}, angle), tilted, 3.0 * std::cos(0.6));
  expectIrradiance(sun({0, -1, 0}, 1.5707963f), up, 3.0);
  // All around: pi L whatever the normal.
  expectIrradiance(sphere({0.2f, 0, 0}, 0.5f), up, 3.0 / 0.25);
  expectIrradiance(sphere({0.2f, 0, 0}, 0.5f), -up, 3.0 / 0.25);
  const Estimate behind = lampLight(lambert(up), up, {disk({0, 2, 0}, {0, 1, 0}, 0.5f)}, nullptr, 64, 1);
  EXPECT_EQ(behind.mean.x, 0.0);
}

TEST(ReferenceLamp, EveryStrategyGivesTheSameLight) {
  Scene scene;
  scene.materials.resize(1);
  Primitive board;  // hides a part of each light
  board.positions = {{-1, 1, -1}, {0.1f, 1, -1}, {0.1f, 1, 1}, {-1, 1, 1}};
  board.normals.assign(4, glm::vec3(0, 1, 0));
  board.indices = {0, 1, 2, 0, 2, 3};
  board.material = 0;
  scene.primitives.push_back(board);
  const RayScene rays(scene);
  Surface surface = lambert({0, 1, 0});
  surface.brdf = {glm::dvec3(0.4), glm::dvec3(0.2), glm::dvec3(1.0), 0.5, 0.25};
  const glm::dvec3 wo = glm::normalize(glm::dvec3(-0.6, 0.7, 0.1));
  for (const Light& light : {sphere({0.4f, 2, 0}, 0.8f), disk({0.4f, 2, 0.3f}, glm::normalize(glm::vec3(-0.3f, -1, 0)), 1.0f), sun({0, -1, 0}, 0.5f)}) {
    const Estimate combined = lampLight(surface, wo, {light}, &rays, 1 << 16, 1);
    ASSERT_GT(combined.mean.x, 0.01);
    const Estimate open = lampLight(surface, wo, {light}, nullptr, 1 << 14, 1);
    EXPECT_LT(combined.mean.x, 0.9 * open.mean.x) << "the board hides nothing";
    for (const Strategy strategy : {Strategy::light, Strategy::reflection, Strategy::cosine}) {
      const Estimate pure = lampLight(surface, wo, {light}, &rays, 1 << 16, 2, strategy);
      const double sigma = std::sqrt(pure.varianceOfMean.x + combined.varianceOfMean.x);
      EXPECT_LE(sigma, 0.02 * combined.mean.x);
      EXPECT_LE(std::abs(pure.mean.x - combined.mean.x), 5.0 * sigma) << static_cast<int>(strategy);
    }
  }
}

// What is behind the light does not hide it, nor what it sits on.
TEST(ReferenceLamp, OnlyWhatIsInFrontOfALightHidesIt) {
  Scene scene;
  scene.materials.resize(1);
  Primitive ceiling;
  ceiling.positions = {{-9, 2, -9}, {9, 2, -9}, {9, 2, 9}, {-9, 2, 9}};
  ceiling.normals.assign(4, glm::vec3(0, -1, 0));
  ceiling.indices = {0, 1, 2, 0, 2, 3};
  ceiling.material = 0;
  scene.primitives.push_back(ceiling);
  const RayScene rays(scene);
  const glm::dvec3 up(0, 1, 0);
  for (const Light& light : {disk({0, 2, 0}, {0, -1, 0}, 0.5f), sphere({0, 1, 0}, 0.2f)}) {
    const Estimate open = lampLight(lambert(up), up, {light}, nullptr, 256, 3), under = lampLight(lambert(up), up, {light}, &rays, 256, 3);
    EXPECT_EQ(open.mean, under.mean);
    EXPECT_GT(under.mean.x, 0.0);
  }
}

}  // namespace
}  // namespace chiaro
