// What pixels ask while they are shaded, and that the renderer goes by what it is answered.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

#include "assets/error.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/runtime/unoccluded.h"

namespace chiaro {
namespace {

Material plastic(float roughness, float metallic) {
  Material m;
  m.roughnessFactor = roughness;
  m.metallicFactor = metallic;
  m.baseColorFactor = glm::vec4(0.8f, 0.5f, 0.2f, 1.0f);
  return m;
}

class Tape : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const BakedScene baked = sphereOf({});
    camera_ = defaultCamera(baked.scene, 1);
    renderer_.emplace(baked);
    SgEnvironmentSettings coarse;
    coarse.finestResolution = 64;
    renderer_->setEnvironment(prepareEnvironment(loadEnvironment("sunny"), coarse));
  }
  static void TearDownTestSuite() { renderer_.reset(); }

  void draw(const Material& material) {
    renderer_->setMaterials({material});
    renderer_->render(camera_, settings_);
    picture_ = renderer_->readRadiance();
    tape_ = renderer_->record(camera_, settings_);
  }
  ImageRgba replayed(const ShadingTape& tape) {
    renderer_->replay(camera_, settings_, tape);
    return renderer_->readRadiance();
  }
  /// Answers every question of these kinds with one value.
  ShadingTape answered(std::initializer_list<ShadingAsks> kinds, glm::vec3 value) const {
    ShadingTape tape = tape_;
    for (auto& question : tape.questions) {
      const bool asked = question.code > 0.0f && std::find(kinds.begin(), kinds.end(), question.asks()) != kinds.end();
      question.answer = value;
      question.code = asked ? 1.0f : 0.0f;
    }
    return tape;
  }

  static Camera camera_;
  static std::optional<Renderer> renderer_;
  RenderSettings settings_ = smallPicture(24);
  ImageRgba picture_;
  ShadingTape tape_;
};

Camera Tape::camera_;
std::optional<Renderer> Tape::renderer_;

TEST_F(Tape, HoldsWhatEachPixelIsAndAsks) {
  draw(plastic(0.3f, 0.0f));
  ASSERT_EQ(tape_.starts.size(), 24u * 24u + 1u);
  EXPECT_EQ(tape_.starts.back(), tape_.questions.size());
  for (std::size_t pixel = 0; pixel < picture_.texels.size(); ++pixel) {
    const auto first = tape_.starts[pixel], last = tape_.starts[pixel + 1];
    ASSERT_EQ(last > first, picture_.texels[pixel].a > 0.5f) << pixel;
    if (first == last) continue;
    const auto surface = shadedSurface(&tape_.questions[first]);
    // The unit sphere: its normal is where it is, but for the facets.
    EXPECT_NEAR(glm::dot(surface.n, glm::normalize(surface.position)), 1.0f, 1e-2f);
    EXPECT_NEAR(surface.alphaT, 0.09f, 1e-5f);
    EXPECT_NEAR(surface.diffuse.r, 0.8f, 1e-5f);
    EXPECT_NEAR(surface.f0.r, 0.04f, 1e-5f);
    std::array<int, 7> asked{};
    for (auto q = first + kSurfaceNotes; q < last; ++q) {
      ++asked.at(static_cast<std::size_t>(tape_.questions[q].asks()));
      EXPECT_NEAR(glm::length(tape_.questions[q].axis), 1.0f, 1e-4f);
    }
    EXPECT_EQ(asked[static_cast<std::size_t>(ShadingAsks::irradiance)], 1);
    EXPECT_EQ(asked[static_cast<std::size_t>(ShadingAsks::fixedShare)], 64) << "diffuse light, and without levels the broad share of the reflection";
    EXPECT_GE(asked[static_cast<std::size_t>(ShadingAsks::lobe)], 1);
    EXPECT_EQ(asked[static_cast<std::size_t>(ShadingAsks::lobe)], asked[static_cast<std::size_t>(ShadingAsks::mean)]);
  }
}

TEST_F(Tape, WithoutAnswersThePictureIsTheSame) {
  for (const auto& material : {plastic(0.3f, 0.0f), plastic(0.55f, 1.0f)}) {
    draw(material);
    EXPECT_EQ(replayed(answered({}, glm::vec3(7))).texels, picture_.texels);
  }
}

TEST_F(Tape, AnswersTakeTheirPlace) {
  for (const auto& material : {plastic(0.3f, 0.0f), plastic(0.55f, 1.0f), plastic(0.9f, 0.0f)}) {
    draw(material);
    // Nothing arrives.
    for (const auto& texel : replayed(answered({ShadingAsks::lobe, ShadingAsks::irradiance, ShadingAsks::rest, ShadingAsks::share}, glm::vec3(0))).texels)
      EXPECT_EQ(glm::vec3(texel), glm::vec3(0));
    // Light is linear: twice of everything that arrives, where no light of its own is asked for apart, is twice the picture.
    const auto one = replayed(answered({ShadingAsks::lobe, ShadingAsks::irradiance, ShadingAsks::rest, ShadingAsks::share}, glm::vec3(1)));
    auto doubled = answered({ShadingAsks::lobe, ShadingAsks::irradiance, ShadingAsks::rest, ShadingAsks::share}, glm::vec3(2));
    const auto two = replayed(doubled);
    for (std::size_t i = 0; i < one.texels.size(); ++i)
      if (one.texels[i].a > 0.5f) {
        EXPECT_GT(one.texels[i].g, 0.0f);
        EXPECT_NEAR(two.texels[i].g / one.texels[i].g, 2.0f, 1e-4f);
      }
  }
}

TEST_F(Tape, RefusesWhatItCannotHold) {
  draw(plastic(0.3f, 0.0f));
  RenderSettings other = settings_;
  other.supersample = 2;
  EXPECT_THROW(renderer_->record(camera_, other), Error);
  other = smallPicture(16);
  EXPECT_THROW(renderer_->replay(camera_, other, tape_), Error);
  // And draws as before afterwards.
  renderer_->render(camera_, settings_);
  EXPECT_EQ(renderer_->readRadiance().texels, picture_.texels);
}

}  // namespace
}  // namespace chiaro
