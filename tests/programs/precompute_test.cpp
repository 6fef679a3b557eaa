// chiaro-precompute as its users meet it: options, messages, exit codes, files.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/transfer/transfer.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

const std::vector<std::string> kFast{"--resolution", "16", "--terms", "8", "--directions", "8"};

/// A table on a floor, as an OBJ without normals: about 300 vertices.
std::string writeTable(const char* name = "table.obj", int floorCells = 12) {
  std::ofstream file(name);
  int count = 0;
  const auto grid = [&](double x0, double y, double z0, double size, int cells) {
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) file << "v " << x0 + size * i / cells << " " << y << " " << z0 - size * j / cells << "\n";
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const int a = count + 1 + j * (cells + 1) + i;
        file << "f " << a << " " << a + 1 << " " << a + cells + 2 << " " << a + cells + 1 << "\n";
      }
    count += (cells + 1) * (cells + 1);
  };
  grid(-2, 0, 2, 4, floorCells);
  grid(-0.6, 0.8, 0.6, 1.2, 8);
  return name;
}

Finished precompute(std::vector<std::string> arguments) { return runProgram("chiaro-precompute", arguments); }

Finished bakeTable(const std::string& output, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{writeTable(), "-o", output};
  arguments.insert(arguments.end(), kFast.begin(), kFast.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  return precompute(arguments);
}

void expectOneLine(const Finished& finished, ExitCode code, const std::string& about) {
  EXPECT_EQ(finished.code, static_cast<int>(code)) << finished.err;
  EXPECT_EQ(finished.errorLines(), 1) << finished.err;
  EXPECT_EQ(finished.err.rfind("chiaro-precompute: ", 0), 0u) << finished.err;
  EXPECT_NE(finished.err.find(about), std::string::npos) << finished.err;
  EXPECT_TRUE(finished.out.empty()) << finished.out;
}

TEST(Precompute, HelpAndVersionGoToStandardOutput) {
  const auto help = precompute({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_TRUE(help.err.empty()) << help.err;
  for (const char* word : {"--output", "--resolution", "--terms", "--directions", "--crease-angle-deg", "--seed", "--threads", "--json", "--quiet",
                           "--verbose", "--memory-limit", "--fresh", "Examples:", "Exit codes:", "builtin:"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  const auto version = precompute({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("chiaro-precompute ", 0), 0u);
}

TEST(Precompute, WrongUsageIsOneLineAndTwo) {
  expectOneLine(precompute({}), ExitCode::usage, "scene");
  expectOneLine(precompute({"builtin:sphere"}), ExitCode::usage, "--output");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--resolution", "15"}, "--resolution"}, {{"--resolution", "512"}, "--resolution"}, {{"--resolution", "18"}, "multiple of 4"},
      {{"--resolution", "many"}, "--resolution"}, {{"--terms", "-1"}, "--terms"}, {{"--clusters", "5000"}, "clusters"}, {{"--weight-bits", "9"}, "weight bits"}, {{"--function-bits", "3"}, "function bits"}, {{"--sample-resolution", "96"}, "sample resolution"}, {{"--least-occluder", "-1"}, "--least-occluder"}, {{"--least-occluder", "nan"}, "--least-occluder"}, {{"--least-occluder", "91"}, "--least-occluder"}, {{"--least-occluder", "1"}, "least occluder"}, {{"--compression", "zip"}, "--compression"}, {{"--preset", "best"}, "--preset"}, {{"--preset", "quality", "--compression", "pca"}, "--preset"}, {{"--preset", "quality", "--target-error", "0.02"}, "--preset"},          {{"--terms", "257"}, "--terms"},
      {{"--directions", "9"}, "--directions"},  {{"--directions", "4"}, "--directions"},   {{"--crease-angle-deg", "nan"}, "--crease-angle-deg"},
      {{"--crease-angle-deg", "-1"}, "--crease-angle-deg"}, {{"--threads", "-2"}, "--threads"}, {{"--refine", "1.5"}, "--refine"},
      {{"--refine", "-0.1"}, "--refine"}, {{"--refine", "nan"}, "--refine"}, {{"--refine-vertices", "-1"}, "--refine-vertices"}, {{"--frobnicate"}, "--frobnicate"},
      {{"--quiet", "--verbose"}, "verbose"},    {{"--json", "out.glb"}, "--json"}, {{"--json", "./out.glb"}, "--json"},
      {{"--json", "out.glb.partial"}, "--json"}, {{"--memory-limit", "-1"}, "--memory-limit"}, {{"--memory-limit", "10"}, "--memory-limit: 10 MiB are too few"}};
  for (const auto& [options, about] : cases) {
    std::vector<std::string> arguments{"builtin:sphere", "-o", "out.glb"};
    EXPECT_FALSE(std::filesystem::exists("out.glb.partial"));
    arguments.insert(arguments.end(), options.begin(), options.end());
    expectOneLine(precompute(arguments), ExitCode::usage, about);
  }
  expectOneLine(precompute({"builtin:sphere", "-o", "out.ply"}), ExitCode::usage, ".glb");
  expectOneLine(precompute({"builtin:nonesuch", "-o", "out.glb"}), ExitCode::usage, "nonesuch");
  EXPECT_FALSE(std::filesystem::exists("out.glb"));
}

TEST(Precompute, NeverWritesOverItsScene) {
  std::ofstream("source.glb") << "precious";
  std::filesystem::remove("link.glb");  // of an earlier run
  std::filesystem::create_symlink("source.glb", "link.glb");
  for (const char* output : {"source.glb", "./source.glb", "link.glb"})
    expectOneLine(precompute({"source.glb", "-o", output}), ExitCode::usage, "--output: names the scene itself");
  expectOneLine(precompute({"source.glb", "-o", "out.glb", "--json", "source.glb"}), ExitCode::usage, "--json: names the scene itself");
  EXPECT_EQ(std::filesystem::file_size("source.glb"), 8u);
}

TEST(Precompute, UnreadableInputIsOneLineAndThree) {
  expectOneLine(precompute({"missing.ply", "-o", "out.glb", "-q"}), ExitCode::unreadableInput, "missing.ply");
  expectOneLine(precompute({"/tmp", "-o", "out.glb", "-q"}), ExitCode::unreadableInput, "/tmp: is a folder");
  std::ofstream("rubbish.glb") << "this is not a scene";
  expectOneLine(precompute({"rubbish.glb", "-o", "out.glb", "-q"}), ExitCode::unreadableInput, "rubbish.glb");
  std::ofstream("flat.obj") << "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";
  expectOneLine(precompute({"flat.obj", "-o", "out.glb", "-q"}), ExitCode::unreadableInput, "flat.obj: has no triangle with an area");
  std::ofstream("far.obj") << "v 10000000.1 0 0\nv 10000000.3 0 0\nv 10000000.3 0.2 0\nf 1 2 3\n";
  expectOneLine(precompute({"far.obj", "-o", "out.glb", "-q"}), ExitCode::unreadableInput, "far.obj: stands too far from the origin");
  EXPECT_FALSE(std::filesystem::exists("out.glb"));
}

TEST(Precompute, UnwritableOutputIsFoundBeforeTheWork) {
  expectOneLine(precompute({"missing.ply", "-o", "no/such/folder/out.glb"}), ExitCode::unwritableOutput, "no/such/folder");
  std::filesystem::create_directory("folder.glb");
  expectOneLine(precompute({"missing.ply", "-o", "folder.glb"}), ExitCode::unwritableOutput, "folder.glb");
  expectOneLine(precompute({"missing.ply", "-o", "out.glb", "--json", "no/such/folder/out.json"}), ExitCode::unwritableOutput, "out.json");
  expectOneLine(precompute({"missing.ply", "-o", std::string(300, 'a') + ".glb"}), ExitCode::unwritableOutput, "too long");
  expectOneLine(precompute({"missing.ply", "-o", "/proc/out.glb"}), ExitCode::unwritableOutput, "/proc/out.glb");
}

TEST(Precompute, WritesASceneAndItsFigures) {
  const auto finished = bakeTable("table.glb", {"--json", "table.json"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_EQ(std::count(finished.out.begin(), finished.out.end(), '\n'), 1) << "one line says what was made";
  EXPECT_NE(finished.err.find("visibility: 100 %"), std::string::npos) << "plain lines where there is no terminal: " << finished.err;
  EXPECT_EQ(finished.err.find('\r'), std::string::npos);

  const auto baked = readBakedScene("table.glb");
  std::ifstream file("table.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json.at("vertices"), baked.scene.vertexCount());
  EXPECT_EQ(json.at("triangles"), 2 * (12 * 12 + 8 * 8));
  EXPECT_EQ(json.at("resolution"), 16);
  EXPECT_EQ(json.at("terms"), baked.transfer.terms);
  // Half of 16 x 16 everywhere, as every normal is up; less than half of 64 x 64, which is traced only where visibility changes.
  EXPECT_GE(json.at("rays_traced"), baked.scene.vertexCount() * 128);
  EXPECT_LE(json.at("rays_traced"), baked.scene.vertexCount() * 1024);
  EXPECT_GT(json.at("bytes_per_vertex").get<double>(), 0.0);
  EXPECT_GT(json.at("peak_memory_bytes").get<double>(), 1e6);
  for (const char* key : {"visibility", "ssdf", "compression", "total"}) EXPECT_GT(json.at("seconds").at(key).get<double>(), 0.0) << key;
  for (const char* key : {"ssdf_rms_radians", "ssdf_sign_share", "visible_fraction_mean_abs_1000"})
    EXPECT_GE(json.at("error").at(key).get<double>(), 0.0) << key;
  EXPECT_EQ(json.at("repairs").at("normals_computed"), baked.scene.vertexCount());
  EXPECT_EQ(json.at("repairs").at("boundary_edges"), 4 * 12 + 4 * 8);
  EXPECT_EQ(json.at("settings").at("directions"), 8);
  EXPECT_EQ(json.at("input"), "table.obj");
  EXPECT_EQ(json.at("output"), "table.glb");
  EXPECT_TRUE(json.contains("version"));
}

TEST(Precompute, PresetsAreSettingsByName) {
  const auto settingsOf = [](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"preset.obj", "-o", "preset.glb", "--json", "preset.json", "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(precompute(arguments).code, 0);
    std::ifstream file("preset.json");
    return nlohmann::json::parse(file).at("settings");
  };
  std::ofstream("preset.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto preview = settingsOf({"--preset", "preview"});
  EXPECT_EQ(preview.at("resolution"), 32);
  EXPECT_EQ(preview.at("bytes_per_vertex"), 36.0);
  EXPECT_EQ(settingsOf({"--preset", "balanced"}), settingsOf({}));
  const auto own = settingsOf({"--preset", "quality", "--resolution", "16"});
  EXPECT_EQ(own.at("resolution"), 16) << "what is given beside it counts";
  EXPECT_EQ(own.at("bytes_per_vertex"), 300.0);
}

TEST(Precompute, RefinesAndSaysSo) {
  ASSERT_EQ(bakeTable("unrefined.glb", {"--json", "unrefined.json"}).code, 0);
  const auto finished = bakeTable("refined.glb", {"--json", "refined.json", "--refine", "0.005", "--refine-vertices", "300"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_NE(finished.out.find("refined: "), std::string::npos) << finished.out;
  EXPECT_NE(finished.err.find("refinement: 100 %"), std::string::npos) << finished.err;
  std::ifstream before("unrefined.json"), after("refined.json");
  const auto plain = nlohmann::json::parse(before), json = nlohmann::json::parse(after);
  EXPECT_EQ(plain.at("refinement").at("vertices_added"), 0);
  const auto& refinement = json.at("refinement");
  EXPECT_GT(refinement.at("vertices_added"), 0);
  EXPECT_EQ(json.at("vertices").get<int>() - plain.at("vertices").get<int>(), refinement.at("vertices_added"));
  EXPECT_EQ(json.at("triangles").get<int>() - plain.at("triangles").get<int>(), refinement.at("triangles_added"));
  EXPECT_LE(json.at("vertices"), 300);
  EXPECT_GT(refinement.at("edges_left_over_budget"), 0);
  EXPECT_GT(refinement.at("passes"), 0);
  EXPECT_GT(refinement.at("worst_error_left"), 0.005);
  EXPECT_GT(refinement.at("rays_traced"), 0);
  EXPECT_GT(json.at("seconds").at("refinement"), 0.0);
  EXPECT_EQ(json.at("settings").at("refine_vertices"), 300);
  EXPECT_EQ(readBakedScene("refined.glb").scene.vertexCount(), json.at("vertices"));
}

TEST(Precompute, QuietIsQuietAndVerboseSaysEverything) {
  const auto quiet = bakeTable("quiet.glb", {"-q"});
  EXPECT_EQ(quiet.code, 0);
  EXPECT_TRUE(quiet.out.empty() && quiet.err.empty()) << quiet.out << quiet.err;
  const auto verbose = bakeTable("verbose.glb", {"-v"});
  for (const char* word : {"ssdf_rms_radians", "normals computed", "peak memory"}) EXPECT_NE(verbose.out.find(word), std::string::npos) << word;
}

TEST(Precompute, SaysUnaskedWhatItLeavesOut) {
  std::ofstream("lines.obj") << "mtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl gone\nf 1 2 3\n";
  std::vector<std::string> arguments{"lines.obj", "-o", "lines.glb"};
  arguments.insert(arguments.end(), kFast.begin(), kFast.end());
  const auto finished = precompute(arguments);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_NE(finished.out.find("warning"), std::string::npos) << finished.out;
  EXPECT_NE(finished.out.find("missing.mtl"), std::string::npos) << finished.out;
}

TEST(Precompute, ThreadsDoNotChangeTheFileSeedsDo) {
  ASSERT_EQ(bakeTable("one.glb", {"-q", "--threads", "1"}).code, 0);
  ASSERT_EQ(bakeTable("five.glb", {"-q", "--threads", "5"}).code, 0);
  ASSERT_EQ(bakeTable("seed.glb", {"-q", "--seed", "7"}).code, 0);
  EXPECT_TRUE(readFile("one.glb") == readFile("five.glb"));
  EXPECT_FALSE(readFile("one.glb") == readFile("seed.glb"));
}

TEST(Precompute, BakesItsOwnOutputAgain) {
  ASSERT_EQ(bakeTable("first.glb", {"-q"}).code, 0);
  auto again = std::vector<std::string>{"first.glb", "-o", "first.glb", "-q"};
  again.insert(again.end(), kFast.begin(), kFast.end());
  const auto before = readBakedScene("first.glb");
  const auto finished = precompute(again);
  EXPECT_EQ(finished.code, 0) << finished.err;
  const auto after = readBakedScene("first.glb");
  EXPECT_EQ(before.scene.primitives[0].positions, after.scene.primitives[0].positions);
  EXPECT_EQ(before.transfer.primitives[0].visibility, after.transfer.primitives[0].visibility);
}

pid_t start(std::vector<std::string> arguments) {
  const std::string program = std::string(std::getenv("CHIARO_BIN_DIR")) + "/chiaro-precompute";
  arguments.insert(arguments.begin(), program);
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execv(program.c_str(), pointers.data());
    ::_exit(127);
  }
  return child;
}

/// Starts a bake of the table that takes some tenths of a second.
pid_t startBake(const std::string& output) {
  return start({"table.obj", "-o", output, "-q", "--resolution", "32", "--terms", "16", "--fresh"});
}

int waitFor(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Files in this folder that begin with `prefix` and are not `prefix` itself: temporaries left behind.
int leftovers(const std::string& prefix) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(".")) {
    const auto name = entry.path().filename().string();
    count += name.rfind(prefix, 0) == 0 && name != prefix;
  }
  return count;
}

TEST(Precompute, AnInterruptLeavesNoOutputAndSays130) {
  writeTable();
  for (const int signal : {SIGINT, SIGTERM}) {
    // A bake that cannot be over before the signal comes.
    const pid_t child = start({"table.obj", "-o", "stopped.glb", "-q", "--resolution", "256", "--terms", "256", "--threads", "1", "--fresh"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_EQ(::kill(child, signal), 0);
    EXPECT_EQ(waitFor(child), 130);
    EXPECT_FALSE(std::filesystem::exists("stopped.glb"));
    const bool partial = std::filesystem::remove("stopped.glb.partial");
    EXPECT_EQ(leftovers("stopped.glb"), 0) << (partial ? "beside what is finished" : "");
  }
}

/// A bake of a second or two whose vertices are more than its sample.
std::vector<std::string> longBake(const std::string& output, const std::string& threads) {
  return {"long.obj", "-o", output, "-q", "--resolution", "16", "--sample-resolution", "32", "--terms", "8", "--clusters", "8", "--functions", "32",
          "--directions", "8", "--threads", threads, "--json", output + ".json"};
}

std::size_t resumed(const std::string& output) {
  std::ifstream file(output + ".json");
  return nlohmann::json::parse(file).at("vertices_resumed");
}

TEST(Precompute, KilledTwentyTimesItGoesOnToTheSameBytes) {
  writeTable("long.obj", 96);
  ASSERT_EQ(waitFor(start(longBake("one.glb", "1"))), 0);
  EXPECT_EQ(resumed("one.glb"), 0u);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(waitFor(start(longBake("three.glb", "3"))), 0);
  const auto whole = std::chrono::steady_clock::now() - begin;
  const auto expected = readFile("one.glb");
  EXPECT_TRUE(readFile("three.glb") == expected);
  EXPECT_EQ(leftovers("three.glb"), 1) << "the JSON, and no .partial";

  for (const char* name : {"killed.glb", "killed.glb.partial"}) std::filesystem::remove(name);
  std::mt19937 random(7);
  int kills = 0, done = 0;
  for (int round = 0; round < 200 && kills < 20; ++round) {
    const pid_t child = start(longBake("killed.glb", round % 2 == 0 ? "3" : "1"));
    std::this_thread::sleep_for(std::chrono::duration_cast<std::chrono::microseconds>(whole * (0.4 * static_cast<double>(random()) * 0x1p-32)));
    ::kill(child, SIGKILL);
    const bool killed = waitFor(child) == 128 + SIGKILL;
    kills += killed;
    if (killed) {
      EXPECT_EQ(std::filesystem::exists("killed.glb"), done > 0);
      continue;
    }
    ++done;
    EXPECT_TRUE(readFile("killed.glb") == expected) << "after " << kills << " kills";
  }
  EXPECT_EQ(kills, 20);
  ASSERT_EQ(waitFor(start(longBake("killed.glb", "2"))), 0);
  EXPECT_TRUE(readFile("killed.glb") == expected);
  EXPECT_FALSE(std::filesystem::exists("killed.glb.partial"));
}

TEST(Precompute, SaysThatItGoesOnAndWhyItStartsAnew) {
  writeTable("long.obj", 96);
  // Stopped while it traces, not before anything is finished: the notice of a later bake tells.
  const auto stop = [&](const std::vector<std::string>& arguments) {
    std::filesystem::remove("told.glb.partial");
    const pid_t child = start(arguments);
    for (int i = 0; i < 1000 && !(std::filesystem::exists("told.glb.partial") && std::filesystem::file_size("told.glb.partial") > 100000); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(child, SIGINT);
    EXPECT_EQ(waitFor(child), 130);
    EXPECT_TRUE(std::filesystem::exists("told.glb.partial"));
  };
  auto loud = longBake("told.glb", "2");
  loud.erase(std::find(loud.begin(), loud.end(), "-q"));
  stop(loud);
  auto finished = precompute(loud);
  EXPECT_EQ(finished.code, 0);
  EXPECT_NE(finished.err.find("chiaro-precompute: told.glb.partial: goes on from what an earlier bake has finished\n"), std::string::npos) << finished.err;
  EXPECT_GT(resumed("told.glb"), 0u);
  stop(loud);
  auto other = loud;
  other.insert(other.end(), {"--seed", "5"});
  finished = precompute(other);
  EXPECT_EQ(finished.code, 0);
  EXPECT_NE(finished.err.find("other settings"), std::string::npos) << finished.err;
  EXPECT_EQ(resumed("told.glb"), 0u);
  std::ofstream("told.glb.partial") << "somebody's notes";
  finished = precompute(longBake("told.glb", "2"));
  expectOneLine(finished, ExitCode::unwritableOutput, "told.glb.partial: is there already");
  EXPECT_EQ(std::filesystem::file_size("told.glb.partial"), 16u);
  std::filesystem::remove("told.glb.partial");
}

TEST(Precompute, KilledAtAnyMomentTheOutputIsOldOrNew) {
  writeTable();
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(waitFor(startBake("killed.glb")), 0);
  const auto whole = std::chrono::steady_clock::now() - start;
  const auto complete = readFile("killed.glb");

  // The old file is another bake, so that old and new cannot be taken for one another.
  ASSERT_EQ(bakeTable("old.glb", {"-q"}).code, 0);
  const auto old = readFile("old.glb");
  std::mt19937 random(20);
  int kills = 0;
  for (int round = 0; round < 20; ++round) {
    std::filesystem::copy_file("old.glb", "killed.glb", std::filesystem::copy_options::overwrite_existing);
    const pid_t child = startBake("killed.glb");
    // Half of the moments fall into the end, where the file is written.
    const double uniform = static_cast<double>(random()) * 0x1p-32;
    const double share = round % 2 == 0 ? uniform : 0.9 + 0.2 * uniform;
    std::this_thread::sleep_for(std::chrono::duration_cast<std::chrono::microseconds>(whole * share));
    ::kill(child, SIGKILL);
    kills += waitFor(child) == 128 + SIGKILL;
    const auto bytes = readFile("killed.glb");
    EXPECT_TRUE(bytes == old || bytes == complete) << "round " << round << ", " << bytes.size() << " bytes";
    EXPECT_NO_THROW(readBakedScene("killed.glb")) << "round " << round;
  }
  EXPECT_GE(kills, 5) << "most bakes were over before the kill: this tested nothing";
}

}  // namespace
}  // namespace chiaro
