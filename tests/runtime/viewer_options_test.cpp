// The option values of chiaro-view, and what it works out from them without a driver.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "assets/error.h"
#include "runtime/render/frame_statistics.h"
#include "runtime/viewer/panel.h"
#include "runtime/viewer/preview.h"
#include "runtime/viewer/view_inputs.h"
#include "runtime/viewer/view_options.h"

namespace chiaro {
namespace {

TEST(ViewOptions, Size) {
  EXPECT_EQ(parseSize("1x16384"), glm::ivec2(1, 16384));
  EXPECT_EQ(parseSize("1920x1080"), glm::ivec2(1920, 1080));
  for (const char* bad : {"", "x", "10", "10x", "x10", "0x10", "10x0", "-5x10", "10x16385", "10x10x10", "10.5x10", "99999999999x1", "10 x 10"})
    EXPECT_THROW(parseSize(bad), Error) << bad;
}

TEST(ViewOptions, PictureFormatIsByName) {
  EXPECT_EQ(pictureFormat("a/b.PNG", "-o"), PictureFormat::png);
  EXPECT_EQ(pictureFormat("b.Exr", "-o"), PictureFormat::exr);
  for (const char* bad : {"b", "b.jpg", ".png", "png", "b.png.txt"}) EXPECT_THROW(pictureFormat(bad, "-o"), Error) << bad;
}

TEST(ViewOptions, DebugViewsHaveNames) {
  EXPECT_EQ(debugViewFromName("none"), DebugView::none);
  EXPECT_EQ(debugViewFromName("ssdf"), DebugView::ssdf);
  EXPECT_EQ(debugViewNames().size(), static_cast<std::size_t>(DebugView::recomputed) + 1);
  EXPECT_THROW(debugViewFromName("depth"), Error);
}

TEST(ViewOptions, EnvironmentTurnsCounterClockwiseFromAbove) {
  const glm::vec3 turned = environmentRotation(90.0) * glm::vec3(0, 0, 1);
  EXPECT_LE(glm::length(turned - glm::vec3(1, 0, 0)), 1e-6f);
  for (const double turns : {360.0, -720.0, 3600.0}) EXPECT_EQ(environmentRotation(turns), glm::mat3(1.0f)) << turns;
  EXPECT_EQ(environmentRotation(45.0), environmentRotation(405.0));
}

TEST(ViewInputs, DroppedFilesAreToldApart) {
  EXPECT_EQ(droppedKind("x/sky.HDR"), DroppedKind::environment);
  EXPECT_EQ(droppedKind("sky.exr"), DroppedKind::environment);
  EXPECT_EQ(droppedKind("scene.glb"), DroppedKind::scene);
  for (const char* other : {"scene.gltf", "mesh.ply", "picture.png", "noextension"}) EXPECT_EQ(droppedKind(other), DroppedKind::other) << other;
}

TEST(FrameStatistics, MinimumMedianMaximumByPass) {
  std::vector<FrameTimings> frames(4);
  const double shade[] = {4.0, 1.0, 3.0, 2.0};
  for (std::size_t i = 0; i < 4; ++i) frames[i].passes = {{"shade", shade[i]}, {"total", 10.0}};
  frames[2].passes.insert(frames[2].passes.begin(), {"upload", 7.0});
  const auto statistics = passStatistics(frames);
  ASSERT_EQ(statistics.size(), 3u);
  EXPECT_EQ(statistics[0].name, "shade");
  EXPECT_EQ(statistics[0].minimum, 1.0);
  EXPECT_EQ(statistics[0].median, 2.5);
  EXPECT_EQ(statistics[0].maximum, 4.0);
  EXPECT_EQ(statistics[2].name, "upload");
  EXPECT_EQ(statistics[2].median, 7.0);
  EXPECT_TRUE(passStatistics({}).empty());
}

TEST(Panel, HistoryForgetsTheOldest) {
  FrameHistory history;
  EXPECT_EQ(history.latest(), 0.0f);
  for (int i = 0; i < 500; ++i) history.add(static_cast<float>(i));
  EXPECT_EQ(history.latest(), 499.0f);
  EXPECT_EQ(history.values().size(), 120u);
  EXPECT_EQ(history.values().front(), 380.0f);
}

TEST(Panel, ExposureInStops) {
  PanelState state;
  EXPECT_EQ(exposureFactor(state, 0.5f), 0.5f);
  state.exposureStops = 2.0f;
  EXPECT_EQ(exposureFactor(state, 0.5f), 2.0f);
  state.autoExposure = false;
  EXPECT_EQ(exposureFactor(state, 0.5f), 4.0f);
}

TEST(Preview, IsTheWholeFrameWhereThatIsFast) {
  RenderSettings full;
  full.supersample = 2;
  const double fast = kPreviewMilliseconds / sampleCount(full);
  EXPECT_EQ(previewSettings(full, fast).width, full.width);
  EXPECT_EQ(previewSettings(full, fast).supersample, 2);
}

TEST(Preview, FirstGivesUpSupersamplingThenSize) {
  RenderSettings full;
  full.supersample = 2;
  const double perSample = kPreviewMilliseconds / sampleCount(full);
  EXPECT_EQ(previewSettings(full, 2.0 * perSample).supersample, 1);
  EXPECT_EQ(previewSettings(full, 2.0 * perSample).width, full.width);
  const RenderSettings coarse = previewSettings(full, 32.0 * perSample);
  EXPECT_EQ(coarse.width, full.width / 3) << "8 times too slow without supersampling: a third each way is enough, a half is not";
  EXPECT_EQ(coarse.height, full.height / 3);
}

TEST(Preview, NeverCoarserThanAnEighthNorEmpty) {
  RenderSettings full;
  EXPECT_EQ(previewSettings(full, std::numeric_limits<double>::infinity()).width, full.width / 8);
  full.width = full.height = 3;
  EXPECT_EQ(previewSettings(full, std::numeric_limits<double>::infinity()).width, 1);
}

}  // namespace
}  // namespace chiaro
