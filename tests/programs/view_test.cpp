// chiaro-view as its user meets it: options, errors, and what --headless writes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/display.h"
#include "runtime/gl/context.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kScene = "small.glb";

Finished view(const std::vector<std::string>& arguments, const Environ& variables = {}) {
  return runProgram("chiaro-view", arguments, variables);
}

/// A user-visible failure: this exit code, exactly one line, and the program's name in front.
void expectFailure(const Finished& run, int code, const std::string& part) {
  EXPECT_EQ(run.code, code) << run.err;
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, StartsWith("chiaro-view: "));
  EXPECT_THAT(run.err, HasSubstr(part));
  EXPECT_EQ(run.out, "");
}

bool glIsThere() {
  static const bool there = [] {
    try {
      gl::HeadlessContext context;
      return true;
    } catch (const Error& error) {
      std::printf("%s\n", error.what());
      return false;
    }
  }();
  return there;
}

class ViewFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() { bakeSmallScene(kScene); }
};

class ViewPictures : public ViewFiles {
 protected:
  void SetUp() override {
    if (!glIsThere()) GTEST_SKIP() << "no OpenGL 4.5 on this machine";
  }
  /// Draws 96x64 headless under a cheap environment, with these options on top, into `name`.
  static void draw(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{kScene, "--headless", "--size", "96x64", "-e", "windows", "-o", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = view(arguments);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_THAT(run.out, HasSubstr("wrote " + name));
  }
  static Image8 png(const std::string& name, const std::vector<std::string>& more = {}) {
    draw(name + ".png", more);
    return readPng(name + ".png");
  }
  static ImageRgba exr(const std::string& name, const std::vector<std::string>& more = {}) {
    draw(name + ".exr", more);
    return readExr(name + ".exr");
  }
  /// The picture that the options are compared with; every run prepares an environment anew, so it is drawn once.
  static const Image8& plain() {
    static const Image8 picture = png("plain");
    return picture;
  }
  static nlohmann::json json(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{kScene, "--headless", "--size", "96x64", "-e", "windows", "--json", name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = view(arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    std::ifstream file(name + ".json");
    return nlohmann::json::parse(file);
  }
};

TEST(ViewProgram, HelpNamesEveryOptionAndGivesExamples) {
  const Finished run = view({"--help"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "");
  for (const char* word : {"--environment", "--rotate-environment-deg", "--size", "--camera", "--orbit", "--exposure", "--tone-map", "--supersample",
                           "--no-background", "--no-shadows", "--debug-view", "--roughness", "--metallic", "--headless", "--window", "--output",
                           "--json", "--frames", "--animate", "--moving", "--start", "--threads", "--quiet", "--version", "Examples", "sunny", "Exit codes"})
    EXPECT_THAT(run.out, HasSubstr(word));
}

TEST(ViewProgram, VersionIsOneLine) {
  const Finished run = view({"--version"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, testing::MatchesRegex("chiaro-view [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(ViewProgram, WrongUsageIsToldBeforeAnyWork) {
  // No scene of that name exists: a mistake in the options must be found first.
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
      {{"--headless", "-o", "a.png", "--size", "640"}, "--size"},
      {{"--headless", "-o", "a.png", "--size", "0x10"}, "--size"},
      {{"--headless", "-o", "a.png", "--camera", "eye=1,2,target=0,0,0"}, "--camera"},
      {{"--headless", "-o", "a.png", "--orbit", "10"}, "--orbit"},
      {{"--headless", "-o", "a.png", "--exposure", "-1"}, "--exposure"},
      {{"--headless", "-o", "a.png", "--exposure", "nan"}, "--exposure"},
      {{"--headless", "-o", "a.png", "--tone-map", "filmic"}, "--tone-map: unknown tone map \"filmic\""},
      {{"--headless", "-o", "a.png", "--debug-view", "depth"}, "--debug-view"},
      {{"--headless", "-o", "a.png", "--supersample", "9"}, "--supersample"},
      {{"--headless", "-o", "a.png", "--supersample", "two"}, "--supersample"},
      {{"--headless", "-o", "a.png", "--frames", "0"}, "--frames"},
      {{"--headless", "-o", "a.png", "--roughness", "1.5"}, "--roughness"},
      {{"--headless", "-o", "a.png", "--metallic", "nan"}, "--metallic"},
      {{"--headless", "-o", "a.png", "--threads", "-1"}, "--threads"},
      {{"--headless", "-o", "a.png", "--threads", "100000"}, "--threads"},
      {{"--headless", "-o", "a.png", "--rotate-environment-deg", "inf"}, "--rotate-environment-deg"},
      {{"--headless", "-o", "a.png", "--start", "nan"}, "--start"},
      {{"--headless", "-o", "a.png", "--animate", "rust"}, "--animate"},
      {{"--headless", "-o", "a.jpg"}, "a.jpg"},
      {{"--headless"}, "--output"},
      {{"--headless", "--window", "-o", "a.png"}, "--window"},
      {{"--headless", "-o", "a.png", "-e", "sunny", "-e", "overcast"}, "--environment"},
      {{"--headless", "-o", "a.png", "--json", "a.png"}, "--json"},
      {{"--headless", "-o", "a.png", "--json", "./a.png"}, "--json"},
      {{"--headless", "--json", "./no_such_scene.glb"}, "--json"},
      {{"--headless", "-o", "sky.exr", "-e", "./sky.exr"}, "--output"},
      {{"-o", "a.png"}, "--headless"},
      {{"--frames", "3"}, "--headless"},
      {{"--headless", "-o", "a.png", "--bogus"}, "--bogus"},
      {{"another.glb", "--headless", "-o", "a.png"}, "another.glb"}};
  for (const auto& [options, part] : mistakes) {
    std::vector<std::string> arguments{"no_such_scene.glb"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    SCOPED_TRACE(testing::PrintToString(options));
    expectFailure(view(arguments), 2, part);
  }
  expectFailure(view({"--headless", "-o", "a.png"}), 2, "baked");
}

TEST(ViewProgram, OutputsAndEnvironmentsAreCheckedBeforeTheScene) {
  expectFailure(view({"no_such_scene.glb", "--headless", "-o", "no_such_folder/a.png"}), 4, "no_such_folder/a.png");
  expectFailure(view({"no_such_scene.glb", "--headless", "--json", "no_such_folder/a.json"}), 4, "no_such_folder/a.json");
  expectFailure(view({"no_such_scene.glb", "--headless", "-o", "a.png", "-e", "sunnny"}), 3, "overcast");
}

TEST(ViewProgram, UnreadableScenes) {
  expectFailure(view({"no_such_scene.glb", "--headless", "-o", "a.png"}), 3, "no_such_scene.glb");
  expectFailure(view({".", "--headless", "-o", "a.png"}), 3, "");
  writeFileAtomically("words.glb", std::string_view("these are words"));
  expectFailure(view({"words.glb", "--headless", "-o", "a.png"}), 3, "words.glb");
  writeFileAtomically("empty.glb", std::string_view());
  expectFailure(view({"empty.glb", "--headless", "-o", "a.png"}), 3, "empty.glb");
}

TEST_F(ViewFiles, DamagedScenes) {
  const auto whole = readFile(kScene);
  for (const double share : {0.001, 0.1, 0.5, 0.999}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    writeFileAtomically("cut.glb", std::span(whole).first(length));
    expectFailure(view({"cut.glb", "--headless", "-o", "a.png"}), 3, "cut.glb");
  }
  auto flipped = whole;
  flipped[flipped.size() - 64] ^= 0x10;  // inside the last block of the transfer
  writeFileAtomically("flipped.glb", std::span(std::as_const(flipped)));
  expectFailure(view({"flipped.glb", "--headless", "-o", "a.png"}), 3, "flipped.glb");
  EXPECT_FALSE(std::filesystem::exists("a.png"));
}

TEST_F(ViewFiles, AnUnbakedSceneIsSentToPrecompute) {
  const auto whole = readFile(kScene);
  std::string text(whole.begin(), whole.end());
  const std::string extension = "CHIARO_radiance_transfer";
  ASSERT_NE(text.find(extension), std::string::npos);
  // The same file under another extension's name (of equal length) is a glTF that Chiaro has not baked.
  for (auto at = text.find(extension); at != std::string::npos; at = text.find(extension)) text.replace(at, 6, "OTHERS");
  writeFileAtomically("unbaked.glb", std::string_view(text));
  expectFailure(view({"unbaked.glb", "--headless", "-o", "a.png"}), 3, "chiaro-precompute");
}

TEST_F(ViewFiles, DamagedEnvironment) {
  writeFileAtomically("words.hdr", std::string_view("#?RADIANCE and then words"));
  expectFailure(view({kScene, "--headless", "-o", "a.png", "-e", "words.hdr"}), 3, "words.hdr");
  if (!glIsThere()) GTEST_SKIP() << "no OpenGL 4.5 on this machine";
  // Readable, but nothing to light with: found later, and named as the file that it is all the same.
  std::filesystem::create_directories("skies");
  writeExr("skies/bright.exr", ImageRgba{8, 4, std::vector<glm::vec4>(32, glm::vec4(1e32f))});
  expectFailure(view({kScene, "--headless", "-o", "a.png", "-e", "skies/bright.exr"}), 3, "chiaro-view: skies/bright.exr: ");
}

TEST_F(ViewFiles, UnknownCameraListsThoseOfTheFile) {
  expectFailure(view({kScene, "--headless", "-o", "a.png", "--camera", "back"}), 2, "0 (front), 1 (side)");
  expectFailure(view({kScene, "--headless", "-o", "a.png", "--camera", "2"}), 2, "0 (front), 1 (side)");
}

TEST_F(ViewFiles, UnknownMovingMeshListsThoseOfTheFile) {
  expectFailure(view({kScene, "--headless", "-o", "a.png", "--moving", "lid"}), 2, "give one of: floor, box");
}

TEST_F(ViewFiles, WithoutADriverOrADisplayOneLineSaysSo) {
  const Environ noEgl{{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"}};
  expectFailure(view({kScene, "--headless", "-o", "a.png"}, noEgl), 1, "OpenGL");
  const Environ noDisplay{{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}, {"XDG_RUNTIME_DIR", ""}};
  expectFailure(view({kScene, "--window", "-o", "a.png"}, noDisplay), 1, "--headless");
  expectFailure(view({kScene}, noDisplay), 1, "--headless");
}

TEST_F(ViewPictures, HasTheAskedSizeAndShowsSomething) {
  const Image8& picture = plain();
  EXPECT_EQ(picture.width, 96);
  EXPECT_EQ(picture.height, 64);
  const auto [darkest, brightest] = std::minmax_element(picture.texels.begin(), picture.texels.end() - 3);
  EXPECT_GE(*brightest - *darkest, 100) << "a lit box under bright windows has contrast";
}

TEST_F(ViewPictures, ExrHoldsRadianceAndCoverage) {
  const ImageRgba picture = exr("radiance");
  ASSERT_EQ(picture.texels.size(), 96u * 64u);
  int covered = 0, open = 0;
  for (const auto& texel : picture.texels) {
    ASSERT_TRUE(std::isfinite(texel.r) && std::isfinite(texel.g) && std::isfinite(texel.b));
    EXPECT_GE(std::min({texel.r, texel.g, texel.b}), 0.0f);
    covered += texel.a == 1.0f;
    open += texel.a == 0.0f;
  }
  EXPECT_GT(covered, 1000);
  EXPECT_GT(open, 500);
}

TEST_F(ViewPictures, PngIsTheExrThroughTheDisplayTransform) {
  // The radiance does not depend on the tone map, so one of each sampling serves.
  for (const char* samples : {"1", "3"}) {
    const ImageRgba radiance = exr("pair", {"--supersample", samples});
    for (const std::string toneMap : {"neutral", "aces", "clamp"}) {
      if (samples[0] == '1' && toneMap != "neutral") continue;
      const Image8 shown = displayImage(radiance, 0.37f, toneMapFromName(toneMap));
      // Both are rounded from the same linear value, once on the GPU and once here: one step at most.
      EXPECT_LE(worstDifference(png("pair", {"--tone-map", toneMap, "--supersample", samples, "--exposure", "0.37"}), shown), 1)
          << toneMap << " " << samples;
    }
  }
}

TEST_F(ViewPictures, AWholeTurnIsNoTurn) {
  EXPECT_EQ(worstDifference(png("turn360", {"--rotate-environment-deg", "360"}), plain()), 0);
  EXPECT_EQ(worstDifference(png("orbit360", {"--orbit", "-360,0"}), plain()), 0);
  EXPECT_GT(worstDifference(png("turn90", {"--rotate-environment-deg", "90"}), plain()), 20);
  EXPECT_GT(worstDifference(png("orbit90", {"--orbit", "90,0"}), plain()), 20);
}

TEST_F(ViewPictures, TheSameCameraByAnyName) {
  EXPECT_EQ(worstDifference(png("index", {"--camera", "0"}), plain()), 0);
  EXPECT_EQ(worstDifference(png("name", {"--camera", "front"}), plain()), 0);
  EXPECT_GT(worstDifference(png("eye", {"--camera", "eye=0,6,0.1,target=0,0,0,fov-deg=50"}), plain()), 20);
}

TEST_F(ViewPictures, OptionsChangeWhatTheySay) {
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--roughness", "0.1"}, {"--metallic", "0"}, {"--no-shadows"}, {"--camera", "side"}, {"--debug-view", "normal"}})
    EXPECT_GT(worstDifference(png("option", options), plain()), 5) << options.front();
  for (const auto& texel : exr("nobackground", {"--no-background"}).texels) {
    if (texel.a == 0.0f) {
      EXPECT_EQ(glm::vec3(texel), glm::vec3(0.0f));
    }
  }
}

TEST_F(ViewPictures, AnimationsStartWhereAsked) {
  EXPECT_LE(worstDifference(png("dry", {"--animate", "wetness"}), plain()), 1) << "a shower begins dry";
  EXPECT_GT(worstDifference(png("wet", {"--animate", "wetness", "--start", "2"}), plain()), 5);
  EXPECT_EQ(worstDifference(png("still", {"--moving", "box"}), plain()), 0);
  EXPECT_GT(worstDifference(png("turned", {"--moving", "box", "--start", "1.5"}), plain()), 5);
  EXPECT_EQ(worstDifference(png("first_key", {"--animate", "scene"}), plain()), 0);
  EXPECT_GT(worstDifference(png("half_way", {"--animate", "scene", "--start", "0.5"}), plain()), 20);
  EXPECT_LE(worstDifference(png("again", {"--animate", "scene", "--start", "1.5"}), readPng("half_way.png")), 1) << "over and over, a second long";
  EXPECT_LE(worstDifference(png("round", {"--moving", "box", "--start", "12"}), plain()), 1) << "a whole turn, 30 degrees a second";
}

TEST_F(ViewPictures, DoesNotDependOnThreads) {
  for (const char* threads : {"1", "3"}) EXPECT_EQ(worstDifference(png("threads", {"--threads", threads}), plain()), 0) << threads;
}

TEST_F(ViewPictures, JsonTellsWhatWasDrawnAndWhatItCost) {
  const auto facts = json("timings", {"--frames", "4", "--supersample", "2"});
  for (const char* key : {"renderer", "version", "vendor"}) EXPECT_FALSE(facts.at("gl").at(key).get<std::string>().empty()) << key;
  EXPECT_EQ(facts.at("size"), nlohmann::json({96, 64}));
  EXPECT_EQ(facts.at("environment"), "windows");
  EXPECT_EQ(facts.at("frames"), 4);
  EXPECT_EQ(facts.at("supersample"), 2);
  EXPECT_EQ(facts.at("bytes").at("file"), std::filesystem::file_size(kScene));
  EXPECT_GT(facts.at("bytes").at("gpu").get<double>(), 0.0);
  EXPECT_GT(facts.at("bytes").at("transfer_per_vertex").get<double>(), 0.0);
  EXPECT_GT(facts.at("exposure").get<double>(), 0.0);
  for (const char* key : {"load", "load_environment", "prepare_environment", "upload", "frames"}) EXPECT_GE(facts.at("seconds").at(key).get<double>(), 0.0) << key;
  const auto& passes = facts.at("passes");
  ASSERT_FALSE(passes.empty());
  for (const auto& pass : passes) {
    const auto& time = pass.at("gpu_ms");
    EXPECT_GE(time.at("min").get<double>(), 0.0);
    EXPECT_LE(time.at("min").get<double>(), time.at("median").get<double>());
    EXPECT_LE(time.at("median").get<double>(), time.at("max").get<double>());
  }
  EXPECT_EQ(passes.back().at("name"), "total");
}

TEST_F(ViewPictures, SaysWhichLampsAreLeftOut) {
  bakeSceneOfLamps("lamps.glb", 40);
  const std::vector<std::string> drawn{"lamps.glb", "--headless", "--size", "8x8", "-e", "white", "-o", "lamps.png"};
  const Finished run = view(drawn);
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "chiaro-view: warning: lamps.glb: 40 punctual lights: only the first 32 are drawn\n");
  bakeSceneOfLamps("lamps.glb", 32);
  EXPECT_EQ(view(drawn).err, "");
}

TEST_F(ViewPictures, AVertexCacheMovesTheMeshThatWasBaked) {
  std::ofstream("tetra.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::vector<float> frames{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.4f, 0, 0, 0, 0.4f, 0, 0, 0, 0.4f};
  std::ofstream("tetra.bin", std::ios::binary).write(reinterpret_cast<const char*>(frames.data()), static_cast<std::streamsize>(frames.size() * sizeof(float)));
  ASSERT_EQ(runProgram("chiaro-precompute", {"tetra.off", "-o", "tetra.glb", "--preset", "preview", "-q"}).code, 0);
  const auto coverage = [](const std::string& start) {
    const Finished run = view({"tetra.glb", "--headless", "--size", "32x32", "-e", "white", "--vertex-frames", "tetra.bin", "--vertex-rest", "tetra.off", "--start", start, "-o", "tetra.exr", "-q"});
    EXPECT_EQ(run.code, 0) << run.err;
    float covered = 0.0f;
    for (const auto& texel : readExr("tetra.exr").texels) covered += texel.a;
    return covered;
  };
  const float large = coverage("0"), small = coverage("0.0333333");
  EXPECT_TRUE(small > 0.0f && small < 0.4f * large) << small << " of " << large;
  const Finished refused = view({"tetra.glb", "--headless", "--vertex-frames", "tetra.off", "--vertex-rest", "tetra.off", "-o", "t.png"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(refused.errorLines(), 1) << refused.err;
  EXPECT_EQ(view({"tetra.glb", "--headless", "--vertex-frames", "tetra.bin", "-o", "t.png"}).code, 2);
}

TEST_F(ViewPictures, QuietPrintsNothing) {
  const Finished run = view({kScene, "--headless", "--size", "8x8", "-e", "white", "-o", "quiet.png", "-q"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out + run.err, "");
}

}  // namespace
}  // namespace chiaro
