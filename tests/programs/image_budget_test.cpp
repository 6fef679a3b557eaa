// The exact answers that the picture's budget is made with, against closed forms; and the error of vertices as colours.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

#include "precompute/report/budget/error_mesh.h"
#include "precompute/report/budget/gaussian_reflectance.h"
#include "precompute/report/budget/traced_light.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr glm::vec3 kUp{0, 1, 0};

/// A large wall in the plane x = .01, from the ground up and below it: half of what the origin sees.
Scene wall() {
  Scene scene;
  Primitive primitive;
  const float far = 1e4f;
  primitive.positions = {{0.01f, -far, -far}, {0.01f, far, -far}, {0.01f, far, far}, {0.01f, -far, far}};
  primitive.normals.assign(4, glm::vec3(-1, 0, 0));
  primitive.indices = {0, 1, 2, 0, 2, 3};
  scene.primitives.push_back(primitive);
  return scene;
}

Environment environmentOf(const std::function<glm::dvec3(glm::dvec3)>& radiance) {
  Environment environment{"test", ImageRgb{512, 256, {}}};
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 512; ++x) environment.radiance.texels.emplace_back(radiance(lobe64::directionFromEquirect(glm::dvec2((x + 0.5) / 512, (y + 0.5) / 256))));
  return environment;
}

reference::Surface ground(double alpha) {
  reference::Surface surface;
  surface.geometricNormal = surface.interpolatedNormal = glm::dvec3(kUp);
  surface.worldFromTangent = glm::dmat3(glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(kUp));
  surface.brdf = {.diffuse = glm::dvec3(0.5), .f0 = glm::dvec3(0.3), .f90 = glm::dvec3(1.0), .alphaX = alpha, .alphaY = alpha};
  return surface;
}

class Answers : public testing::Test {
 protected:
  Answers() : scene_(wall()), rays_(scene_), surface_(ground(0.2)) {}

  Scene scene_;
  RayScene rays_;
  reference::Surface surface_;
  std::vector<SgLight> none_;
  // 4096 stratified rays about an edge: a part in a thousand; sets of them .002.
  TracedLightSettings settings_{.raysPerLobe = 4096, .lightSamples = 4096};
  static constexpr double kTolerance = 4e-3;
};

TEST_F(Answers, OfALitHalf) {
  const auto white = environmentOf([](glm::dvec3) { return glm::dvec3(1.0); });
  const reference::EnvironmentSampler sampler(white, glm::mat3(1.0f));
  TracedLight light(surface_, rays_, sampler, none_, settings_);
  // The wall hides what is towards +x.
  EXPECT_NEAR(light.share(kUp, 10.0).value(), 0.5, kTolerance);
  EXPECT_NEAR(light.cosineShare(kUp, 3.0).value(), 0.5, kTolerance);
  EXPECT_EQ(light.share(glm::normalize(glm::vec3(1, 1, 0)), 1000.0).value(), 0.0);
  EXPECT_EQ(light.share(glm::normalize(glm::vec3(-1, 1, 0)), 1000.0).value(), 1.0);
  EXPECT_FALSE(light.share(-kUp, 1000.0)) << "all of it is below the horizon";
  for (const double sharpness : {1.0, 30.0, 1e5}) EXPECT_NEAR(light.mean(glm::normalize(glm::vec3(1, 1, 1)), sharpness).g, 1.0, kTolerance);
  EXPECT_NEAR(light.lobe(kUp, 10.0).value().g, 0.5, kTolerance);
  EXPECT_NEAR(light.lobe(glm::vec3(0, 0, 1), 10.0).value().g, 0.5, kTolerance) << "of what is above the horizon";
  EXPECT_NEAR(light.rest(kUp, 10.0).value().g, 0.5, kTolerance);
  EXPECT_NEAR(light.irradiance().g, 0.5 * kPi, kPi * kTolerance);
}

TEST_F(Answers, OfASmallSun) {
  // A sharp sun on the free side, which no lobe's own directions find.
  const glm::dvec3 towards = glm::normalize(glm::dvec3(-1, 1, 0.3));
  constexpr double kSharpness = 4000.0, kPeak = 1000.0;
  const auto sun = environmentOf([&](glm::dvec3 w) { return glm::dvec3(kPeak * std::exp(kSharpness * (glm::dot(w, towards) - 1.0))); });
  const double flux = kPeak * 2.0 * kPi / kSharpness;
  const reference::EnvironmentSampler sampler(sun, glm::mat3(1.0f));
  const std::vector<SgLight> known{{.axis = glm::vec3(towards), .sharpness = kSharpness, .amplitude = glm::vec3(kPeak)}};
  TracedLight light(surface_, rays_, sampler, known, {.raysPerLobe = 64, .lightSamples = 4096});
  EXPECT_NEAR(light.irradiance().g / (flux * towards.y), 1.0, 0.01);
  const double density = 8.0 / (2.0 * kPi * (1.0 - std::exp(-16.0))) * std::exp(8.0 * (towards.y - 1.0));
  EXPECT_NEAR(light.mean(kUp, 8.0).g / (flux * density), 1.0, 0.01);
  EXPECT_LE(std::abs(light.rest(kUp, 8.0).value().g), 0.02 * flux * density) << "nothing is left without the light";
  // The reflectance at the sun, times its light.
  const glm::dvec3 wo = glm::normalize(glm::dvec3(0.2, 1, 0)), out = wo * surface_.worldFromTangent, in = towards * surface_.worldFromTangent;
  const double expected = flux * reference::brdfTimesCosine(surface_.brdf, out, in).g;
  for (const std::uint32_t half : {0u, 1u}) EXPECT_NEAR(light.reflected(wo, half).exact.g / expected, 1.0, 0.02);
  reference::Brdf reflection = surface_.brdf;
  reflection.diffuse = glm::dvec3(0.0);
  const double changed = flux * reference::brdfTimesCosine(reflection, out, in).g * (gaussianOverExact(surface_.brdf, out, in) - 1.0);
  EXPECT_NEAR((light.reflected(wo, 0).gaussian.g - light.reflected(wo, 0).exact.g) / expected, changed / expected, 0.02);
}

TEST(GaussianReflectance, KeepsTheEnergyOfTheDistribution) {
  const glm::dvec3 n(0, 0, 1);
  for (const double alpha : {0.05, 0.1, 0.2}) {
    const reference::Brdf brdf{.alphaX = alpha, .alphaY = alpha};
    // Over half vectors seen from the normal: the distribution's own integral of D cos is 1.
    double sum = 0.0, worst = 0.0;
    const int count = 4000;
    for (int i = 0; i < count; ++i) {
      const double theta = 0.5 * kPi * (i + 0.5) / count;
      const glm::dvec3 wh(std::sin(theta), 0.0, std::cos(theta)), wi = 2.0 * wh.z * wh - n;
      const double d = lobe64::ggxDistribution(wh.z, alpha) * wh.z * 2.0 * kPi * std::sin(theta) * 0.5 * kPi / count;
      const double ratio = gaussianOverExact(brdf, n, wi);
      sum += d * ratio;
      if (theta < alpha) worst = std::max(worst, std::abs(ratio - 1.0));
    }
    EXPECT_NEAR(sum, 1.0, 0.02) << alpha;  // what four Gaussians leave of the tail
    EXPECT_LE(worst, 0.02) << alpha;
    EXPECT_GT(worst, 1e-4) << "a fit, not the distribution itself";
  }
  const glm::dvec3 wi = glm::normalize(glm::dvec3(0.5, 0, 1));
  EXPECT_EQ(gaussianOverExact({.alphaX = 0.5, .alphaY = 0.5}, n, wi), 1.0) << "rough: no lobes";
  EXPECT_EQ(gaussianOverExact({.alphaX = 0.1, .alphaY = 0.2}, n, wi), 1.0) << "not told apart";
}

/// Two floors of four vertices, the second far to the right.
Scene floors() {
  Scene scene;
  scene.meshNames = {"near", ""};
  for (const float x : {0.0f, 10.0f}) {
    Primitive primitive;
    primitive.mesh = static_cast<int>(scene.primitives.size());
    primitive.positions = {{x, 0, 1}, {x + 1, 0, 1}, {x + 1, 0, 0}, {x, 0, 0}};
    primitive.normals.assign(4, kUp);
    primitive.texcoords.assign(4, glm::vec2(0.0f));
    primitive.indices = {0, 1, 2, 0, 2, 3};
    scene.primitives.push_back(primitive);
  }
  return scene;
}

TEST(VertexErrors, WorstAreApart) {
  const Scene scene = floors();
  auto crowded = floors();
  crowded.primitives[1].positions[1] = crowded.primitives[1].positions[0] + glm::vec3(0.1f, 0, 0);  // diagonal 11: a fiftieth is .22
  const VertexErrors errors{.error = {0.1f, 0.2f, 0.0f, 0.3f, 0.9f, 0.8f, 0.7f, 0.6f}};
  const auto numbers = [&](const Scene& of) {
    std::vector<std::size_t> all;
    for (const auto& one : worstVertices(of, errors, 4)) all.push_back(one.vertex);
    return all;
  };
  EXPECT_EQ(numbers(scene), (std::vector<std::size_t>{4, 5, 6, 7}));
  EXPECT_EQ(numbers(crowded), (std::vector<std::size_t>{4, 6, 7, 3}));
  const auto worst = worstVertices(scene, errors, 8);
  EXPECT_EQ(worst[0].mesh, "mesh 1");
  EXPECT_EQ(worst[4].mesh, "near");
  EXPECT_EQ(worst[4].position, glm::vec3(0, 0, 0));
}

TEST(ErrorMesh, ColoursAreMagmaOfTheError) {
  const Scene scene = floors();
  const VertexErrors errors{.error = {0.0f, 0.025f, 0.05f, 0.5f, 0.0f, 0.0f, 0.0f, 0.0f}};
  const auto glb = errorMesh(scene, errors, "test");
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const auto json = nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + length);
  EXPECT_EQ(json["extensionsUsed"], nlohmann::json::parse(R"(["KHR_materials_unlit"])"));
  EXPECT_EQ(json["asset"]["extras"]["error_at_pale_yellow"], 0.05);
  const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_FALSE(attributes.contains("TEXCOORD_0"));
  const auto& accessor = json["accessors"][attributes["COLOR_0"].get<std::size_t>()];
  EXPECT_EQ(accessor["count"], 4);
  EXPECT_EQ(accessor["normalized"], true);
  const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  std::uint16_t colors[16];
  std::memcpy(colors, glb.data() + 28 + length + view["byteOffset"].get<std::size_t>(), sizeof colors);
  // #000004, #b73779, #fcfdbf in linear values, the last also for what is beyond the range.
  const double expected[4][3] = {{0, 0, 4}, {183, 55, 121}, {252, 253, 191}, {252, 253, 191}};
  for (int v = 0; v < 4; ++v) {
    for (int c = 0; c < 3; ++c) {
      const double x = expected[v][c] / 255.0, linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
      EXPECT_NEAR(colors[4 * v + c] / 65535.0, linear, v == 1 ? 0.01 : 1e-5) << v << ' ' << c;
    }
    EXPECT_EQ(colors[4 * v + 3], 65535);
  }
}

TEST(ErrorMesh, IsSeenWhereItIs) {
  const Scene scene = floors();
  const RayScene rays(scene);
  const VertexErrors errors{.error = {0, 0, 0, 0, 1, 1, 1, 1}};
  const auto worst = worstVertices(scene, errors, 1).front();
  const auto image = errorMeshPicture(scene, rays, errors, cameraBefore(worst, scene, rays), {31, 31});
  // A corner of the floor: a quarter of the view is pale yellow, seen straight from above, the rest is nothing.
  int pale = 0, nothing = 0;
  for (std::size_t i = 0; i < image.texels.size(); i += 4) {
    pale += image.texels[i] > 200;
    nothing += image.texels[i] == 48;
  }
  EXPECT_NEAR(pale, 31 * 31 / 4, 40);
  EXPECT_EQ(pale + nothing, 31 * 31);
}

}  // namespace
}  // namespace chiaro
