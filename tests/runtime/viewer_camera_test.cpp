// The camera of the command line and of the mouse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "assets/error.h"
#include "assets/scene/camera_spec.h"
#include "runtime/viewer/orbit_camera.h"

namespace chiaro {
namespace {

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0f;

Scene triangleScene() {
  Scene scene;
  scene.primitives.resize(1);
  scene.primitives[0].positions = {{-1, 0, -2}, {3, 0, 0}, {1, 4, 2}};
  scene.primitives[0].indices = {0, 1, 2};
  return scene;
}

Scene sceneWithCameras() {
  Scene scene = triangleScene();
  for (const char* name : {"front", "top", "7"}) {
    Camera camera = lookAt({1, 2, 9}, {1, 2, 0}, 0.5f, boundsOf(scene));
    camera.name = name;
    camera.verticalFov = 0.3f + 0.1f * static_cast<float>(scene.cameras.size());
    scene.cameras.push_back(camera);
  }
  return scene;
}

std::string errorOf(const std::string& spec) {
  try {
    parseCameraSpec(spec);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_EQ(error.where(), "--camera");
    return error.what();
  }
  return "";
}

/// Largest difference of two matrices' entries; NaN counts as infinite.
float difference(const glm::mat4& a, const glm::mat4& b) {
  float worst = 0.0f;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) {
      const float d = std::abs(a[column][row] - b[column][row]);
      worst = d <= worst ? worst : std::isnan(d) ? std::numeric_limits<float>::infinity() : d;
    }
  return worst;
}

glm::vec3 eyeOf(const Camera& camera) { return glm::vec3(camera.worldFromCamera[3]); }
glm::vec3 backOf(const Camera& camera) { return glm::vec3(camera.worldFromCamera[2]); }

/// How far the matrix's rotation is from orthonormal and right-handed.
float rigidError(const Camera& camera) {
  const glm::mat3 r(camera.worldFromCamera);
  return difference(glm::mat4(glm::transpose(r) * r), glm::mat4(1.0f)) + std::abs(glm::determinant(r) - 1.0f);
}

/// Where a point lands, in pictures' heights from the middle, +x right, +y up.
glm::vec2 project(const Camera& camera, glm::vec3 point) {
  const glm::vec4 p = glm::inverse(camera.worldFromCamera) * glm::vec4(point, 1.0f);
  if (!camera.perspective) return glm::vec2(p) / (2.0f * camera.verticalExtent);
  return glm::vec2(p) / (-p.z * 2.0f * std::tan(0.5f * camera.verticalFov));
}

TEST(CameraSpec, ReadsEachForm) {
  EXPECT_EQ(parseCameraSpec("auto").kind, CameraSpec::Kind::automatic);
  EXPECT_EQ(parseCameraSpec("12").kind, CameraSpec::Kind::index);
  EXPECT_EQ(parseCameraSpec("12").index, 12);
  EXPECT_EQ(parseCameraSpec("Camera.001").kind, CameraSpec::Kind::name);
  EXPECT_EQ(parseCameraSpec("name=auto").name, "auto");
  const auto spec = parseCameraSpec("eye=1,-2.5,+3e1,target=0,1,0,fov-deg=60");
  EXPECT_EQ(spec.kind, CameraSpec::Kind::lookAt);
  EXPECT_EQ(spec.eye, glm::vec3(1, -2.5f, 30));
  EXPECT_EQ(spec.target, glm::vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(spec.verticalFov, 60.0f * kDegrees);
  EXPECT_EQ(parseCameraSpec("target=0,1,0,eye=1,2,3").eye, glm::vec3(1, 2, 3)) << "the order is free";
  EXPECT_FLOAT_EQ(parseCameraSpec("eye=1,2,3,target=0,0,0").verticalFov, 40.0f * kDegrees);
}

TEST(CameraSpec, RefusesEachMistakeWithItsReason) {
  EXPECT_THAT(errorOf(""), testing::HasSubstr("is empty"));
  EXPECT_THAT(errorOf("eye=1,2,target=0,0,0"), testing::HasSubstr("eye needs three numbers, not 2"));
  EXPECT_THAT(errorOf("eye=1,2,3"), testing::HasSubstr("target needs three numbers, not 0"));
  EXPECT_THAT(errorOf("eye=1,2,3,4,target=0,0,0"), testing::HasSubstr("not 4"));
  EXPECT_THAT(errorOf("eye=1,2,x,target=0,0,0"), testing::HasSubstr("\"x\" is not a number"));
  EXPECT_THAT(errorOf("eye=1,2,nan,target=0,0,0"), testing::HasSubstr("\"nan\" is not a number"));
  EXPECT_THAT(errorOf("eye=1,2,inf,target=0,0,0"), testing::HasSubstr("\"inf\" is not a number"));
  EXPECT_THAT(errorOf("eye=1,2,3,eye=1,2,3"), testing::HasSubstr("given twice"));
  EXPECT_THAT(errorOf("1,2,3,eye=1,2,3"), testing::HasSubstr("is not a number"));
  EXPECT_THAT(errorOf("eye=1,2,3,target=1,2,3"), testing::HasSubstr("same point"));
  EXPECT_THAT(errorOf("eye=1,2,3,target=0,0,0,fov-deg=0"), testing::HasSubstr("between 0 and 180"));
  EXPECT_THAT(errorOf("eye=1,2,3,target=0,0,0,fov-deg=180"), testing::HasSubstr("between 0 and 180"));
  EXPECT_THAT(errorOf("eye=1,2,3,up=0,1,0"), testing::HasSubstr("unknown key \"up\""));
  EXPECT_THAT(errorOf("99999999999"), testing::HasSubstr("too large"));
}

TEST(CameraSpec, FindsCamerasOfTheScene) {
  const Scene scene = sceneWithCameras();
  EXPECT_EQ(resolveCamera(parseCameraSpec("auto"), scene, 1.5f).name, "front");
  EXPECT_EQ(resolveCamera(parseCameraSpec("1"), scene, 1.5f).name, "top");
  EXPECT_EQ(resolveCamera(parseCameraSpec("top"), scene, 1.5f).name, "top");
  EXPECT_EQ(resolveCamera(parseCameraSpec("name=7"), scene, 1.5f).name, "7");
  for (const char* missing : {"3", "left"}) {
    try {
      resolveCamera(parseCameraSpec(missing), scene, 1.5f);
      ADD_FAILURE() << missing << " was found";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      EXPECT_THAT(error.what(), testing::HasSubstr("the file has 0 (front), 1 (top), 2 (7)"));
    }
  }
}

TEST(CameraSpec, PrintedViewParsesToItself) {
  const glm::vec3 eye(0.1f, -3.75e-5f, 1234.5f), target(1.0f / 3.0f, 2, 0);
  const auto spec = parseCameraSpec(lookAtSpec(eye, target, 0.7f));
  EXPECT_EQ(spec.eye, eye);
  EXPECT_EQ(spec.target, target);
  EXPECT_NEAR(spec.verticalFov, 0.7f, 1e-6f);  // degrees and back: two roundings
}

TEST(CameraSpec, OrbitAngles) {
  const glm::vec2 angles = parseOrbit("90,-45");
  EXPECT_FLOAT_EQ(angles.x, 90.0f * kDegrees);
  EXPECT_FLOAT_EQ(angles.y, -45.0f * kDegrees);
  EXPECT_EQ(parseOrbit("720,0"), glm::vec2(0.0f));
  for (const char* bad : {"", "90", "90,", "90,1,2", "a,b", "nan,0"}) EXPECT_THROW(parseOrbit(bad), Error) << bad;
}

TEST(Orbit, CarriesTheCameraAroundItsTarget) {
  const Bounds bounds = boundsOf(triangleScene());
  const Camera camera = lookAt({1, 2, 9}, {1, 2, 0}, 0.5f, bounds);
  // The bounds are centred on (1, 2, 0); a quarter turn counter-clockwise from above takes +Z to +X.
  const Camera quarter = orbited(camera, {1, 2, 0}, 90.0f * kDegrees, 0.0f);
  EXPECT_LE(glm::length(eyeOf(quarter) - glm::vec3(10, 2, 0)), 1e-5f);
  EXPECT_LE(glm::length(backOf(quarter) - glm::vec3(1, 0, 0)), 1e-6f);
  const Camera up = orbited(camera, {1, 2, 0}, 0.0f, 30.0f * kDegrees);
  EXPECT_NEAR(eyeOf(up).y, 2.0f + 9.0f * 0.5f, 1e-5f);
  EXPECT_LE(glm::length(project(up, {1, 2, 0})), 1e-6f) << "the target stays in the middle";
  EXPECT_LE(rigidError(up), 1e-5f);
}

TEST(Orbit, StopsShortOfThePoles) {
  const Camera camera = lookAt({0, 0, 5}, {0, 0, 0}, 0.5f, {});
  for (const float elevation : {90.0f, 170.0f, -90.0f, -170.0f}) {
    const Camera moved = orbited(camera, glm::vec3(0.0f), 0.0f, elevation * kDegrees);
    EXPECT_NEAR(std::abs(eyeOf(moved).y), 5.0f * std::sin(89.0f * kDegrees), 1e-4f) << elevation;
    EXPECT_GT(moved.worldFromCamera[1].y, 0.0f) << "never upside down";
  }
}

TEST(Orbit, NoAnglesIsNoChange) {
  const Camera camera = lookAt({3, 1, -5}, {0.3f, 0, 0}, 0.5f, boundsOf(triangleScene()));
  EXPECT_EQ(difference(orbited(camera, {1, 1, 1}, 0.0f, 0.0f).worldFromCamera, camera.worldFromCamera), 0.0f);
}

TEST(Orbit, KeepsRollAndSurvivesLookingStraightDown) {
  Camera camera = lookAt({0, 5, 0}, {0, 0, 0}, 0.5f, {});
  const Camera turned = orbited(camera, glm::vec3(0.0f), 40.0f * kDegrees, -20.0f * kDegrees);
  EXPECT_LE(rigidError(turned), 1e-5f);
  EXPECT_LE(std::abs(glm::length(eyeOf(turned)) - 5.0f), 1e-5f);
  EXPECT_LE(glm::length(project(turned, glm::vec3(0.0f))), 1e-6f);
}

TEST(OrbitCamera, IsTheGivenCameraUntilTouched) {
  const Scene scene = sceneWithCameras();
  OrbitCamera orbit(scene.cameras[1], boundsOf(scene));
  EXPECT_EQ(difference(orbit.camera().worldFromCamera, scene.cameras[1].worldFromCamera), 0.0f);
  EXPECT_EQ(orbit.camera().nearPlane, scene.cameras[1].nearPlane);
  EXPECT_LE(glm::length(orbit.target() - glm::vec3(1, 2, 0)), 1e-5f);
}

TEST(OrbitCamera, DragsFollowThePointer) {
  const Scene scene = triangleScene();
  for (const bool perspective : {true, false}) {
    Camera camera = lookAt({1, 2, 9}, {1, 2, 0}, 0.5f, boundsOf(scene));
    camera.perspective = perspective;
    camera.verticalExtent = 3.0f;
    OrbitCamera orbit(camera, boundsOf(scene));
    orbit.pan(0.25f, -0.125f);
    // What stood in the middle, at the target's depth, has moved exactly as the pointer has.
    EXPECT_LE(glm::length(project(orbit.camera(), {1, 2, 0}) - glm::vec2(0.25f, -0.125f)), 1e-6f) << perspective;
  }
}

TEST(OrbitCamera, DollyScalesTheDistanceAndNeverArrives) {
  const Scene scene = triangleScene();
  OrbitCamera orbit(lookAt({1, 2, 9}, {1, 2, 0}, 0.5f, boundsOf(scene)), boundsOf(scene));
  orbit.dolly(1.0f);
  EXPECT_NEAR(orbit.distance(), 9.0f / 1.1f, 1e-4f);
  orbit.dolly(-1.0f);
  EXPECT_NEAR(orbit.distance(), 9.0f, 1e-4f);
  for (int i = 0; i < 1000; ++i) orbit.dolly(1.0f);
  EXPECT_GT(orbit.distance(), 0.0f);
  EXPECT_LE(rigidError(orbit.camera()), 1e-5f);
  for (int i = 0; i < 1000; ++i) orbit.orbit(0.37f, 0.11f);
  EXPECT_LE(rigidError(orbit.camera()), 1e-4f) << "turns do not add up to a skew";
}

TEST(OrbitCamera, FramesTheWholeScene) {
  const Scene scene = triangleScene();
  for (const float aspect : {0.4f, 1.0f, 2.5f}) {
    for (const bool perspective : {true, false}) {
      Camera camera = lookAt({30, -7, 2}, {0, 0, 1}, 0.9f, boundsOf(scene));
      camera.perspective = perspective;
      OrbitCamera orbit(camera, boundsOf(scene));
      orbit.frame(aspect);
      for (const auto& point : scene.primitives[0].positions) {
        const glm::vec2 at = project(orbit.camera(), point);
        EXPECT_LE(std::abs(at.x), 0.5f * aspect + 1e-5f) << aspect << perspective;
        EXPECT_LE(std::abs(at.y), 0.5f + 1e-5f) << aspect << perspective;
        const float depth = -(glm::inverse(orbit.camera().worldFromCamera) * glm::vec4(point, 1.0f)).z;
        EXPECT_GE(depth, orbit.camera().nearPlane);
        EXPECT_LE(depth, orbit.camera().farPlane);
      }
    }
  }
}

}  // namespace
}  // namespace chiaro
