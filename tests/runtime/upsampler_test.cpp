// Upsampled frames: what they may never show, whatever moved between them. How near they come to shading every pixel is measured, not tested
// (docs/accuracy.md), but for one bound that no mistake would meet.
#include <gtest/gtest.h>

#include <cmath>

#include "assets/error.h"
#include "assets/scene/camera_spec.h"
#include "runtime/render/renderer.h"
#include "tests/lobe/gl_test_main.h"
#include "tests/runtime/unoccluded.h"
#include "tests/runtime/upsampled.h"

namespace chiaro {
namespace {

TEST(Upsampler, WithoutUpsamplingNothingOfItShows) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked);
  renderer.setEnvironment(environment("sunny"));
  const ImageRgba before = frame(renderer, around(baked, 20), smallPicture(kSize));
  for (int f = 0; f < 3; ++f) renderer.render(around(baked, static_cast<float>(f)), upsampled(4));
  EXPECT_EQ(frame(renderer, around(baked, 20), smallPicture(kSize)).texels, before.texels);
}

// Whatever the sharpness of lobes, and where the sharpest and the broadest meet in one cell.
TEST(Upsampler, StaysFiniteAtTheExtremes) {
  const SgEnvironment& sunny = environment("sunny");
  std::vector<BakedScene> scenes{sphereOf(metal(0.0f)), sphereOf(metal(1.0f))};
  Material exponent = metal(0.5f);
  exponent.reflectance = Reflectance::blinnPhong;
  exponent.reflectanceWidth = glm::vec2(1e6f);
  scenes.push_back(sphereOf(exponent));
  Scene both = builtinScene("ornament");
  for (std::size_t m = 0; m < both.materials.size(); ++m) both.materials[m] = m % 2 == 0 ? exponent : matte();
  scenes.push_back(unoccluded(std::move(both)));
  for (const auto& baked : scenes) {
    Renderer renderer(baked);
    renderer.setEnvironment(sunny);
    const Camera camera = defaultCamera(baked.scene, 1);
    for (const int cell : {2, 3, 4}) {
      for (const auto weights : {UpsampleWeights::lobe, UpsampleWeights::normal, UpsampleWeights::bilinear}) {
        for (int f = 0; f < 2; ++f) {
          const ImageRgba image = frame(renderer, orbited(camera, {0, 0, 0}, 0.02f * static_cast<float>(f), 0.0f), upsampled(cell, weights, 0.05f));
          for (const auto& texel : image.texels)
            for (int c = 0; c < 3; ++c) ASSERT_TRUE(texel[c] >= 0.0f && texel[c] <= 1e6f) << texel[c] << " with cells of " << cell;
        }
      }
    }
  }
}

TEST(Upsampler, ABudgetOfEveryPixelShadesWhatTheFilterFailed) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked);
  renderer.setEnvironment(environment("sunny"));
  const Camera camera = around(baked, 10);
  const ImageRgba full = frame(renderer, camera, smallPicture(kSize));
  const ImageRgba alone = frame(renderer, camera, upsampled(4));
  EXPECT_EQ(renderer.recomputed().second, 0u);
  renderer.setEnvironment(environment("sunny"));  // without history again
  const ImageRgba helped = frame(renderer, camera, upsampled(4, UpsampleWeights::lobe, 1.0f));
  const auto [wanted, shaded] = renderer.recomputed();
  EXPECT_GT(wanted, 0u);
  EXPECT_EQ(shaded, wanted);
  // A tenth of the error at most; what is left are pixels whose samples all look alike.
  EXPECT_LE(rmse(helped, full), 0.1 * rmse(alone, full));
}

TEST(Upsampler, TheBudgetHolds) {
  const BakedScene baked = sphereOf(metal(0.1f));
  Renderer renderer(baked);
  renderer.setEnvironment(environment("windows"));
  for (const float share : {0.0f, 0.01f, 0.1f}) {
    renderer.render(around(baked, 100.0f * share), upsampled(4, UpsampleWeights::lobe, share));
    EXPECT_LE(renderer.recomputed().second, static_cast<unsigned>(share * kSize * kSize)) << share;
  }
}

TEST(Upsampler, BothWeightsBeatBilinearOnesOfAMovingView) {
  const BakedScene baked = sphereOf(metal(0.2f));
  Renderer full(baked), test(baked);
  const SgEnvironment& windows = environment("windows");
  full.setEnvironment(windows);
  test.setEnvironment(windows);
  double error[3] = {};
  for (const auto weights : {UpsampleWeights::lobe, UpsampleWeights::normal, UpsampleWeights::bilinear})
    for (int f = 0; f < 8; ++f) {
      const Camera camera = around(baked, 0.5f * static_cast<float>(f));
      const ImageRgba image = frame(test, camera, upsampled(4, weights));
      if (f >= 4) error[static_cast<int>(weights)] += rmse(image, frame(full, camera, smallPicture(kSize)));
    }
  EXPECT_LT(error[0], error[2]);
  EXPECT_LT(error[1], error[2]);
}

TEST(Upsampler, ALightThatIsSwitchedOffIsGoneInThreeFrames) {
  const BakedScene baked = sphereOf(matte());
  Renderer renderer(baked);
  renderer.setEnvironment(environment("overcast"));
  const Camera camera = around(baked, 0);
  const ImageRgba dark = frame(renderer, camera, smallPicture(kSize));
  renderer.setLights({headlight(20.0f)});
  ImageRgba image;
  for (int f = 0; f < 20; ++f) image = frame(renderer, camera, upsampled(4));
  const double lit = rmse(image, dark);
  const ImageRgba alone = [&] {
    Renderer fresh(baked);
    fresh.setEnvironment(environment("overcast"));
    return frame(fresh, camera, upsampled(4));
  }();
  renderer.setLights({});
  for (int f = 0; f < 3; ++f) image = frame(renderer, camera, upsampled(4));
  ASSERT_GT(lit, 1.0);
  // What a frame without any history is off by, and a hundredth of the light.
  EXPECT_LE(rmse(image, dark), rmse(alone, dark) + 0.01 * lit);
}

// Black where there is no light now, whatever there was before.
TEST(Upsampler, NothingIsLeftAfterACutAResizeOrAnotherEnvironment) {
  const BakedScene baked = sphereOf(matte());
  Renderer renderer(baked);
  const SgEnvironment &black = environment("black"), &white = environment("white");
  renderer.setEnvironment(black);
  renderer.setLights({headlight(20.0f)});
  const auto warmUp = [&](float degrees) {
    ImageRgba image;
    for (int f = 0; f < 6; ++f) image = frame(renderer, around(baked, degrees), upsampled(4));
    return largest(image);
  };
  for (const auto weights : {UpsampleWeights::lobe, UpsampleWeights::normal}) {
    ASSERT_GT(warmUp(0), 1.0f);
    const float seen = largest(frame(renderer, around(baked, 180), upsampled(4, weights)));
    const float truth = largest(frame(renderer, around(baked, 180), smallPicture(kSize)));
    EXPECT_LE(seen, truth + 0.01f) << "cut to the side in the dark";
  }
  ASSERT_GT(warmUp(0), 1.0f);
  renderer.setLights({});
  RenderSettings larger = upsampled(4);
  larger.width = kSize + 13;
  EXPECT_EQ(largest(frame(renderer, around(baked, 0), larger)), 0.0f) << "resized";
  renderer.setEnvironment(white);
  ASSERT_GT(warmUp(0), 0.5f);
  renderer.setEnvironment(black);
  EXPECT_EQ(largest(frame(renderer, around(baked, 0), upsampled(4))), 0.0f) << "another environment";
}

TEST(Upsampler, AMovedMeshIsFollowed) {
  const BakedScene baked = sphereOf(metal(0.2f));
  Renderer full(baked), test(baked);
  const SgEnvironment& windows = environment("windows");
  full.setEnvironment(windows);
  test.setEnvironment(windows);
  const Camera camera = around(baked, 0);
  double moved = 0.0, still = 0.0;
  for (int f = 0; f < 12; ++f) {
    glm::mat4 pose(1.0f);
    pose[3][0] = 0.01f * static_cast<float>(f);
    const std::vector<glm::mat4> poses(baked.scene.meshNames.size(), pose);
    full.setPoses(poses);
    test.setPoses(poses);
    const ImageRgba image = frame(test, camera, upsampled(2));
    if (f >= 6) moved += rmse(image, frame(full, camera, smallPicture(kSize)));
  }
  Renderer resting(baked);
  resting.setEnvironment(windows);
  for (int f = 0; f < 12; ++f) {
    resting.setEnvironment(windows);  // no history
    const ImageRgba image = frame(resting, camera, upsampled(2));
    full.setPoses(std::vector<glm::mat4>(baked.scene.meshNames.size(), glm::mat4(1.0f)));
    if (f >= 6) still += rmse(image, frame(full, camera, smallPicture(kSize)));
  }
  EXPECT_LT(moved, still) << "what was shaded before the mesh moved was of use";
}

// Every pixel was shaded itself in 16 frames of a still picture: then hardly any is worth shading again.
TEST(Upsampler, AStillPictureSettles) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked), full(baked);
  renderer.setEnvironment(environment("sunny"));
  full.setEnvironment(environment("sunny"));
  const Camera camera = around(baked, 10);
  const RenderSettings settings = upsampled(4, UpsampleWeights::lobe, 0.1f);
  renderer.render(camera, settings);
  const unsigned first = renderer.recomputed().first;
  for (int f = 0; f < 40; ++f) renderer.render(camera, settings);
  EXPECT_LT(renderer.recomputed().first, first / 10);
  const ImageRgba truth = frame(full, camera, smallPicture(kSize));
  EXPECT_LE(rmse(renderer.readRadiance(), truth), 2e-3 * largest(truth));
}

// Radiance does not know the exposure; what is kept of it may not either.
TEST(Upsampler, AnotherExposureChangesNothingThatIsKept) {
  const BakedScene baked = sphereOf(matte());
  for (const char* name : {"black", "windows"}) {
    Renderer renderer(baked);
    renderer.setEnvironment(environment(name));
    renderer.setLights({headlight()});
    RenderSettings settings = upsampled(4);
    for (int f = 0; f < 20; ++f) renderer.render(around(baked, 20), settings);
    const ImageRgba before = renderer.readRadiance();
    settings.exposure *= 1.1f;
    EXPECT_LE(rmse(frame(renderer, around(baked, 20), settings), before), 0.002 * largest(before)) << name;
  }
}

// Light and exposure far from 1 in opposite directions show the same picture.
TEST(Upsampler, AllIsRelativeToTheEnvironment) {
  const BakedScene baked = sphereOf(metal(0.1f));
  Environment scaled = loadEnvironment("sunny");
  ImageRgba reference;
  for (const float scale : {1.0f, 1e6f, 1e-6f}) {
    Environment source = scaled;
    for (auto& texel : source.radiance.texels) texel *= scale;
    Renderer renderer(baked);
    renderer.setEnvironment(prepareEnvironment(source));
    RenderSettings settings = upsampled(4, UpsampleWeights::lobe, 0.05f);
    settings.exposure /= scale;
    ImageRgba image;
    for (int f = 0; f < 4; ++f) image = frame(renderer, around(baked, static_cast<float>(f)), settings);
    for (auto& texel : image.texels) texel = glm::vec4(glm::vec3(texel) / scale, texel.a);
    if (scale == 1.0f) reference = image;
    else EXPECT_LE(rmse(image, reference), 1e-3 * largest(reference)) << scale;
  }
}

// Its light is beyond the range of a float; once it is out, nothing of it is left.
TEST(Upsampler, WhatIsNotANumberIsNotKept) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked);
  renderer.setEnvironment(environment("overcast"));
  renderer.setLights({headlight(3e38f)});
  for (int f = 0; f < 4; ++f) renderer.render(around(baked, 0), upsampled(4, UpsampleWeights::lobe, 0.1f));
  renderer.setLights({});
  ImageRgba image;
  for (int f = 0; f < 20; ++f) image = frame(renderer, around(baked, 0), upsampled(4, UpsampleWeights::lobe, 0.1f));
  EXPECT_LE(rmse(image, frame(renderer, around(baked, 0), smallPicture(kSize))), 0.01);
}

TEST(Upsampler, CutCellsAnOrthographicViewAndSupersamplingConverge) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked), full(baked);
  renderer.setEnvironment(environment("sunny"));
  full.setEnvironment(environment("sunny"));
  Camera orthographic = around(baked, 15);
  orthographic.perspective = false;
  orthographic.verticalExtent = 0.6f;  // the sphere fills the picture to its border
  for (const int supersample : {1, 2}) {
    RenderSettings settings = upsampled(4);
    settings.width = 65;
    settings.height = 63;
    settings.supersample = supersample;
    for (const Camera& camera : {around(baked, 15), orthographic}) {
      ImageRgba image;
      for (int f = 0; f < 32; ++f) image = frame(renderer, camera, settings);
      RenderSettings whole = settings;
      whole.upsample = 1;
      const ImageRgba truth = frame(full, camera, whole);
      EXPECT_LE(rmse(image, truth), 3e-3 * largest(truth));
      double border = 0.0;
      for (int y = 0; y < image.height; ++y) border = std::max(border, static_cast<double>(std::abs(image.at(64, y).r - truth.at(64, y).r)));
      EXPECT_LE(border, 0.01 * largest(truth)) << "the last column";
    }
  }
}

TEST(Upsampler, ABudgetOfTimeShadesSomeAndNeverMoreThanAsked) {
  const BakedScene baked = sphereOf(metal(0.1f));
  Renderer renderer(baked);
  renderer.setEnvironment(environment("windows"));
  RenderSettings settings = upsampled(4);
  settings.width = settings.height = 4 * kSize;
  settings.recompute = {.share = 0.0f, .milliseconds = 1e4f};
  unsigned most = 0;
  for (int f = 0; f < 12; ++f) {
    renderer.render(around(baked, 3.0f * static_cast<float>(f)), settings);
    const auto [wanted, shaded] = renderer.recomputed();
    EXPECT_LE(shaded, wanted);
    if (f == 0) {
      EXPECT_LE(shaded, 1024u) << "nothing is known of the driver yet";
    }
    most = std::max(most, shaded);
  }
  EXPECT_GT(most, 1024u) << "ten seconds are enough for more";
}

TEST(Upsampler, ItsDebugViewsAreBlackWithoutIt) {
  const BakedScene baked = sphereOf(metal(0.3f));
  Renderer renderer(baked);
  renderer.setEnvironment(environment("sunny"));
  for (const auto view : {DebugView::totalWeight, DebugView::age, DebugView::recomputed}) {
    RenderSettings settings = smallPicture(kSize);
    settings.debugView = view;
    EXPECT_EQ(largest(frame(renderer, around(baked, 0), settings)), 0.0f);
    settings.upsample = 4;
    EXPECT_TRUE(largest(frame(renderer, around(baked, 0), settings)) <= 1.0f);
  }
}

std::vector<PrimitiveShape> movedBy(const Scene& scene, glm::vec3 shift, float scale = 1.0f) {
  std::vector<PrimitiveShape> shapes;
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    shapes.push_back({p, scene.primitives[p].positions, scene.primitives[p].normals});
    for (auto& position : shapes.back().positions) position = scale * position + shift;
  }
  return shapes;
}

TEST(Shapes, AreDrawnLikeASceneThatWasBakedSo) {
  const BakedScene baked = sphereOf(metal(0.3f));
  const auto shapes = movedBy(baked.scene, {0.3f, 0.1f, 0.0f}, 0.5f);
  BakedScene there = baked;
  for (const auto& shape : shapes) there.scene.primitives[shape.primitive].positions = shape.positions;
  Renderer renderer(baked), truth(there);
  renderer.setEnvironment(environment("sunny"));
  truth.setEnvironment(environment("sunny"));
  renderer.render(around(baked, 10), smallPicture(kSize));
  renderer.setShapes(shapes);
  const ImageRgba picture = frame(renderer, around(baked, 10), smallPicture(kSize));
  EXPECT_GT(largest(picture), 0.1f);
  EXPECT_EQ(picture.texels, frame(truth, around(baked, 10), smallPicture(kSize)).texels);
}

// Vertices that all move alike are a mesh that moves, and pixels are found again as exactly.
TEST(Shapes, AreFollowedAsMovedMeshesAre) {
  const BakedScene baked = sphereOf(metal(0.2f));
  Renderer shaped(baked), posed(baked), lost(baked), full(baked);
  for (auto* renderer : {&shaped, &posed, &lost, &full}) renderer->setEnvironment(environment("windows"));
  const Camera camera = around(baked, 0);
  double followed = 0.0, alone = 0.0;
  ImageRgba truth;
  for (int f = 0; f < 12; ++f) {
    const glm::vec3 shift(0.01f * static_cast<float>(f + 1), 0.0f, 0.0f);
    glm::mat4 pose(1.0f);
    pose[3] = glm::vec4(shift, 1.0f);
    const auto shapes = movedBy(baked.scene, shift);
    for (auto* renderer : {&shaped, &lost, &full}) renderer->setShapes(shapes);
    posed.setPoses(std::vector<glm::mat4>(baked.scene.meshNames.size(), pose));
    lost.setEnvironment(environment("windows"));  // no history
    const ImageRgba a = frame(shaped, camera, upsampled(2)), b = frame(posed, camera, upsampled(2)), c = frame(lost, camera, upsampled(2));
    truth = frame(full, camera, smallPicture(kSize));
    EXPECT_LE(rmse(a, b), 2e-3 * largest(truth)) << "frame " << f;
    if (f < 6) continue;
    followed += rmse(a, truth);
    alone += rmse(c, truth);
  }
  EXPECT_LT(followed, alone);
}

TEST(Shapes, RefuseOtherNumbersOfVertices) {
  const BakedScene baked = sphereOf(matte());
  Renderer renderer(baked);
  auto shapes = movedBy(baked.scene, {});
  shapes[0].normals.pop_back();
  EXPECT_THROW(renderer.setShapes(shapes), Error);
  shapes[0].primitive = 99;
  EXPECT_THROW(renderer.setShapes(shapes), Error);
}

}  // namespace
}  // namespace chiaro
