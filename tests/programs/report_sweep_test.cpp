// `chiaro-report sweep`: its front, what it keeps, and the program as its user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/report/sweep/pareto.h"
#include "precompute/report/sweep/sweep.h"
#include "precompute/report/sweep/sweep_store.h"
#include "tests/programs/browser.h"
#include "tests/programs/view_support.h"

namespace chiaro {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string textOf(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

/// Three coarse bakes, and seven baselines unless `bakesAlone`, in a few seconds; nothing is drawn.
std::vector<std::string> quick(const std::string& folder, bool bakesAlone = false) {
  std::vector<std::string> all{"sweep", "builtin:sphere", "--ground", "-o", folder, "--vertices", "4", "--points-inside", "3", "--rays", "64", "--resolution", "16", "--bytes", "8,24"};
  if (bakesAlone) all.insert(all.end(), {"--no-baselines", "--no-frames"});
  return all;
}

TEST(Pareto, KeepsWhatNothingBeatsAtOnce) {
  //                                       cheap  good  between  beaten  as cheap, worse  as good, dearer  twin of the first  unknown
  const std::vector<double> cost{1, 4, 2, 3, 1, 5, 1, kNone}, error{8, 1, 4, 4, 9, 1, 8, 0};
  EXPECT_THAT(paretoFront(cost, error), ElementsAre(true, true, true, false, false, false, true, false));
  EXPECT_TRUE(paretoFront({}, {}).empty());
}

SweepResult someResult(int terms) {
  SweepResult result{.point = {.terms = terms}, .figures = {.bytesPerVertex = 0.1, .seconds = kNone, .cpuSeconds = 2.0 / 3.0}};
  result.figures.atVertices.fill(1.0 / 3.0);
  result.figures.inTriangles.fill(kNone);
  return result;
}

TEST(SweepStore, KeepsWholeLinesOfItsOwnKey) {
  const std::filesystem::path path = "store.jsonl";
  std::filesystem::remove(path);
  {
    SweepStore store(path, "one");
    store.append(someResult(1));
    store.append(someResult(2));
    EXPECT_THROW(SweepStore(path, "one"), Error) << "two at a time";
  }
  SweepStore(path, "other").append(someResult(3));
  const std::string whole = textOf(path);
  writeFileAtomically(path, whole + "{\"key\":\"one\",\"form\":\"joi");  // what a kill tore
  {
    const SweepStore store(path, "one");
    EXPECT_EQ(textOf(path), whole);
    const auto found = store.find(someResult(2).point);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->figures.bytesPerVertex, 0.1) << "to the last digit";
    EXPECT_EQ(found->figures.cpuSeconds, 2.0 / 3.0);
    EXPECT_EQ(found->figures.atVertices[6], 1.0 / 3.0);
    EXPECT_TRUE(std::isnan(found->figures.inTriangles[0]));
    EXPECT_FALSE(store.find(someResult(3).point)) << "it has another key";
  }
  EXPECT_THROW(SweepStore("no/such/folder.jsonl", "one"), Error);
}

TEST(SweepFigures, WorstIsUndefinedWhereOneIs) {
  ErrorBySharpness error{1, 3, 2, 0, 0, 0, 0};
  EXPECT_EQ(SweepFigures::worst(error), 3.0);
  error[0] = kNone;
  EXPECT_TRUE(std::isnan(SweepFigures::worst(error)));
}

/// One sweep that several tests look at.
class FinishedSweep : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::filesystem::remove_all("sweep_all");
    auto arguments = quick("sweep_all");
    arguments.insert(arguments.end(), {"--size", "48x32", "--samples", "8", "--frames", "2", "--lobes", "0,1", "--target-error", "0.03"});
    run_ = runProgram("chiaro-report", arguments);
  }
  static Finished run_;
};

Finished FinishedSweep::run_;

TEST_F(FinishedSweep, WritesEverythingItSays) {
  ASSERT_EQ(run_.code, 0) << run_.err;
  const auto json = nlohmann::json::parse(textOf("sweep_all/sweep.json"));
  EXPECT_EQ(json["program"], "chiaro-report sweep");
  ASSERT_EQ(json["points"].size(), 2u * (2u + 1u) + 7u);  // with both numbers of lobes: joint, pca; baselines
  std::vector<double> cost, error, frame, picture;
  std::vector<bool> front, frontOfFrames;
  for (const auto& point : json["points"]) {
    SCOPED_TRACE(point.dump());
    cost.push_back(point["bytes_per_vertex"]);
    error.push_back(point["error"]);
    front.push_back(point["on_front_of_bytes"]);
    double worst = 0.0;
    for (const double value : point["mean_abs_at_vertices"]) worst = std::max(worst, value);
    EXPECT_EQ(worst, error.back());
    EXPECT_TRUE(worst > 0.0 && worst < 0.5);
    const bool baked = point["form"] == "joint" || point["form"] == "pca";
    EXPECT_EQ(point["cpu_seconds"].is_number(), baked);
    EXPECT_EQ(point["frame_ms"].is_number(), baked);
    EXPECT_EQ(point["picture_rmse"].is_number(), baked);
    frame.push_back(baked ? point["frame_ms"].get<double>() : kNone);
    picture.push_back(baked ? point["picture_rmse"].get<double>() : kNone);
    frontOfFrames.push_back(point["on_front_of_frame_ms"]);
    if (baked) {
      EXPECT_GT(frame.back(), 0.0);
      EXPECT_TRUE(picture.back() > 0.0 && picture.back() < 0.3);
    }
    // 2 % is what a bake promises of its bytes.
    if (point["form"] == "joint") {
      EXPECT_LE(cost.back(), 1.02 * point["bytes"].get<double>());
    }
  }
  EXPECT_EQ(front, paretoFront(cost, error));
  EXPECT_EQ(frontOfFrames, paretoFront(frame, picture));
  for (std::size_t i = 0; i < 6; i += 2) {
    SCOPED_TRACE(i);
    EXPECT_EQ(error[i], error[i + 1]) << "one bake, drawn twice";
    EXPECT_EQ(json["points"][i]["cpu_seconds"], json["points"][i + 1]["cpu_seconds"]);
    EXPECT_LT(picture[i], picture[i + 1]) << "one lobe is further off";
  }
  // Both joint bakes are within .03, the first with fewer bytes; it is then the faster to draw that counts.
  const std::size_t chosen = json["chosen"];
  EXPECT_TRUE(chosen < 2);
  EXPECT_LE(frame[chosen], frame[1 - chosen]);
  EXPECT_THAT(run_.out, HasSubstr("chiaro-precompute builtin:sphere -o baked.glb --compression joint --resolution 16 --bytes 8"));
  EXPECT_FALSE(std::filesystem::exists("sweep_all/baked"));
  const std::string csv = textOf("sweep_all/sweep.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 13);
  EXPECT_THAT(run_.out, HasSubstr("13 points, 0 of them known before"));
}

/// Starts a sweep, sends it `signal` as soon as one point is in `store`, and waits: its status.
int stoppedEarly(const std::vector<std::string>& arguments, const std::filesystem::path& store, int signal) {
  std::vector<std::string> words{std::string(std::getenv("CHIARO_BIN_DIR")) + "/chiaro-report", "-q"};
  words.insert(words.begin() + 1, arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, words[0].c_str(), nullptr, nullptr, pointers.data(), environ) != 0) throw std::runtime_error("cannot run " + words[0]);
  int status = 0;
  pid_t ended = 0;
  std::error_code absent;
  while (std::filesystem::file_size(store, absent) == 0 || absent) {
    ended = ::waitpid(child, &status, WNOHANG);
    if (ended != 0) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (ended != 0) return status;
  ::kill(child, signal);
  ::waitpid(child, &status, 0);
  return status;
}

TEST(ReportSweep, GoesOnAfterAKill) {
  std::filesystem::remove_all("sweep_killed");
  const int killed = stoppedEarly(quick("sweep_killed", true), "sweep_killed/sweep.jsonl", SIGKILL);
  ASSERT_TRUE(WIFSIGNALED(killed)) << "the sweep was over before it could be killed";
  EXPECT_FALSE(std::filesystem::exists("sweep_killed/index.html"));
  const std::string before = textOf("sweep_killed/sweep.jsonl");
  const auto done = std::count(before.begin(), before.end(), '\n');
  ASSERT_TRUE(done >= 1 && done < 3) << done;
  const Finished run = runProgram("chiaro-report", quick("sweep_killed", true));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 points, " + std::to_string(done) + " of them known before"));
  const std::string after = textOf("sweep_killed/sweep.jsonl");
  EXPECT_THAT(after, StartsWith(before.substr(0, before.rfind('\n') + 1)));
  EXPECT_EQ(std::count(after.begin(), after.end(), '\n'), 3);
  // Once more nothing is left to do, and the page is the same.
  const std::string page = textOf("sweep_killed/index.html");
  ASSERT_EQ(runProgram("chiaro-report", quick("sweep_killed", true)).code, 0);
  EXPECT_EQ(textOf("sweep_killed/sweep.jsonl"), after);
  EXPECT_EQ(textOf("sweep_killed/index.html"), page);
}

TEST(ReportSweep, AnInterruptKeepsWhatIsFinished) {
  std::filesystem::remove_all("sweep_interrupted");
  const int status = stoppedEarly(quick("sweep_interrupted", true), "sweep_interrupted/sweep.jsonl", SIGINT);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string kept = textOf("sweep_interrupted/sweep.jsonl");
  EXPECT_GE(std::count(kept.begin(), kept.end(), '\n'), 1);
  EXPECT_FALSE(std::filesystem::exists("sweep_interrupted/index.html"));
}

/// Of the sweeps above the joint bakes, with so many bytes a vertex; nothing is drawn.
std::vector<std::string> joint(const std::string& folder, const std::string& bytes, const std::vector<std::string>& more) {
  std::vector<std::string> all{"sweep", "builtin:sphere", "--ground", "-o", folder, "--vertices", "4", "--points-inside", "3", "--rays", "64", "--resolution", "16", "--compression", "joint", "--no-baselines",
                               "--no-frames", "--bytes", bytes};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST_F(FinishedSweep, BakesOfSeveralProcessesAreTheSame) {
  ASSERT_EQ(run_.code, 0) << run_.err;
  std::filesystem::remove_all("sweep_jobs");
  const Finished run = runProgram("chiaro-report", joint("sweep_jobs", "8,24", {"--jobs", "2"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_FALSE(std::filesystem::exists("sweep_jobs/baked"));
  const auto one = nlohmann::json::parse(textOf("sweep_all/sweep.json"))["points"], several = nlohmann::json::parse(textOf("sweep_jobs/sweep.json"))["points"];
  ASSERT_EQ(several.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    for (const char* figure : {"bytes", "bytes_per_vertex", "mean_abs_at_vertices", "mean_abs_in_triangles"}) EXPECT_EQ(several[i][figure], one[2 * i][figure]) << figure;
}

TEST(ReportSweep, GoesOnFromBakesThatWait) {
  // As a process of a sweep with several jobs leaves it, when the sweep is killed before it measures.
  std::filesystem::remove_all("sweep_waiting");
  std::filesystem::create_directories("sweep_waiting/baked");
  ASSERT_EQ(runProgram("chiaro-report", joint("sweep_waiting", "8", {"--bake-point", "0", "--bake-threads", "1"})).code, 0);
  const auto files = std::filesystem::directory_iterator("sweep_waiting/baked");
  int count = 0;
  for (const auto& file : files) {
    ++count;
    if (file.path().extension() == ".json") writeFileAtomically(file.path(), std::string_view(R"({"seconds": 1234.5, "cpu_seconds": 4321.5})"));
  }
  EXPECT_EQ(count, 2) << "the bake, and how long it took";
  ASSERT_EQ(runProgram("chiaro-report", joint("sweep_waiting", "8", {})).code, 0);
  EXPECT_EQ(nlohmann::json::parse(textOf("sweep_waiting/sweep.json"))["points"][0]["cpu_seconds"], 4321.5) << "not baked again";
  EXPECT_FALSE(std::filesystem::exists("sweep_waiting/baked"));
}

TEST(ReportSweep, AFailedProcessIsSaidInOneLine) {
  std::filesystem::remove_all("sweep_failed");
  std::string command = "ulimit -f 8; exec '" + std::string(std::getenv("CHIARO_BIN_DIR")) + "/chiaro-report'";  // no file of a bake is that small
  for (const auto& word : joint("sweep_failed", "8", {"--jobs", "2", "-q"})) command += " '" + word + "'";
  const int status = std::system((command + " 2>failed.txt").c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const std::string said = textOf("failed.txt");
  EXPECT_THAT(said, StartsWith("chiaro-report: bake of joint, 16 x 16, "));
  EXPECT_THAT(said, HasSubstr("ended by signal"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_FALSE(std::filesystem::exists("sweep_failed/index.html"));
}

SweepResult drawn(double bytes, double error, double milliseconds, double picture) {
  SweepResult result{.point = {.bytes = bytes}, .figures = {.bytesPerVertex = bytes, .frameMilliseconds = milliseconds, .pictureRmse = picture}};
  result.figures.atVertices.fill(error);
  return result;
}

TEST(Choice, IsTheCheapestWithinTheTargets) {
  std::vector<SweepResult> results{drawn(100, 0.01, 9, 0.02), drawn(50, 0.02, 5, 0.03), drawn(20, 0.03, 5, 0.04), drawn(20, 0.03, 4, 0.05)};
  results.push_back({.point = {.form = SweepForm::haar}, .figures = {.bytesPerVertex = 1, .frameMilliseconds = 1, .pictureRmse = 0}});
  EXPECT_EQ(choose(results, 0.02, {}), 1u);
  EXPECT_EQ(choose(results, 0.05, {}), 3u) << "as few bytes, drawn faster";
  EXPECT_EQ(choose(results, {}, 5.0), 1u) << "the least error of the picture";
  EXPECT_EQ(choose(results, {}, 100.0), 0u);
  EXPECT_EQ(choose(results, 0.01, 9.0), 0u);
  EXPECT_EQ(choose(results, 0.01, 5.0), std::nullopt);
  EXPECT_EQ(choose({drawn(1, kNone, kNone, kNone)}, 1.0, 1.0), std::nullopt) << "what is not known is not within";
  EXPECT_EQ(commandsOf({.form = SweepForm::joint, .resolution = 32, .bytes = 36, .weightBits = 8, .lobes = 3, .prefilter = 128}, "a.glb"),
            "chiaro-precompute a.glb -o baked.glb --compression joint --resolution 32 --bytes 36\nchiaro-view baked.glb --lobes 3 --prefilter 128");
}

TEST(Jobs, AreAtLeastOneAndAtMostTheThreads) {
  const std::vector<SweepPoint> points{{.resolution = 64}};
  EXPECT_EQ(jobsThatFit(points, std::size_t{1} << 40, 8), 1) << "no machine holds two of these";
  EXPECT_EQ(jobsThatFit(points, 100, 1), 1);
  EXPECT_LE(jobsThatFit(points, 100, 2), 2);
}

void expectFailure(const std::vector<std::string>& arguments, int code, const std::string& part) {
  const Finished run = runProgram("chiaro-report", arguments);
  EXPECT_EQ(run.code, code) << run.err;
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, StartsWith("chiaro-report: "));
  EXPECT_THAT(run.err, HasSubstr(part));
}

TEST(ReportSweep, Errors) {
  expectFailure({"sweep", "missing.ply", "-o", "sweep_none"}, 3, "missing.ply");
  writeFileAtomically("torn.glb", std::string_view("glTF\2\0\0\0"));
  expectFailure({"sweep", "torn.glb", "-o", "sweep_none"}, 3, "torn.glb");
  expectFailure({"sweep", "builtin:sphere", "-o", "sweep_none", "--resolution", "30"}, 2, "resolution");
  expectFailure({"sweep", "builtin:sphere", "-o", "sweep_none", "--weight-bits", "9"}, 2, "weight bits");
  expectFailure({"sweep", "builtin:sphere", "-o", "sweep_none", "--vertices", "0"}, 2, "--vertices");
  expectFailure({"sweep", "builtin:sphere", "-o", "sweep_none", "--prefilter", "100"}, 2, "--prefilter");
  expectFailure({"sweep", "builtin:sphere", "-o", "sweep_none", "--no-frames", "--target-frame-time", "5"}, 2, "--target-frame-time");
  bakeSmallScene("baked.glb");
  expectFailure({"sweep", "baked.glb", "-o", "sweep_none"}, 2, "baked.glb");
  EXPECT_FALSE(std::filesystem::exists("sweep_none")) << "no report of what cannot be read";
  writeFileAtomically("a_file", std::string_view("x"));
  expectFailure({"sweep", "builtin:sphere", "-o", "a_file/sweep"}, 4, "a_file");
}

TEST_F(FinishedSweep, PageInABrowser) {
  if (!chromium()) GTEST_SKIP() << "no chromium: install it, or name it in CHIARO_CHROMIUM";
  ASSERT_EQ(run_.code, 0) << run_.err;
  const std::string dom = documentAfter("sweep_all/index.html", R"(
    const root = document.documentElement.dataset, chart = Chart.getChart('chart');
    const canvas = document.getElementById('chart'), pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    root.inked = pixels.some(value => value !== 0);
    root.points = chart.data.datasets.filter(set => set.label !== 'front').reduce((sum, set) => sum + set.data.length, 0);
    const bytes = chart.options.scales.x.title.text, cost = document.getElementById('cost');
    cost.value = 'cpu_seconds';
    cost.dispatchEvent(new Event('change'));
    root.axis = bytes + ' then ' + Chart.getChart('chart').options.scales.x.title.text;
    cost.value = 'frame_ms';
    const measure = document.getElementById('measure');
    measure.value = '8';
    measure.dispatchEvent(new Event('change'));
    const drawn = Chart.getChart('chart');
    root.drawn = drawn.data.datasets.filter(set => set.label !== 'front').reduce((sum, set) => sum + set.data.length, 0) + ' ' + drawn.options.scales.x.title.text + ' ' + drawn.options.scales.y.title.text;
    const column = index => [...document.querySelectorAll('#points tbody tr')].map(row => Number(row.cells[index].dataset.value));
    const sorted = values => values.every((value, i) => i === 0 || values[i - 1] <= value);
    const head = document.querySelectorAll('#points th button')[3];
    head.click();
    root.up = sorted(column(3));
    head.click();
    root.down = sorted(column(3).reverse()) && !sorted(column(3));
    document.querySelectorAll('#points th button')[2].click();
    const last = [...document.querySelectorAll('#points tbody tr')].at(-1).cells[2];
    root.empty = last.textContent;
    root.requests = performance.getEntriesByType('resource').filter(entry => !entry.name.startsWith('data:')).length;
    root.fits = document.documentElement.scrollWidth <= innerWidth;
  )");
  EXPECT_THAT(dom.substr(0, 1000), Not(HasSubstr("data-error")));
  for (const char* state : {"data-inked=\"true\"", "data-points=\"13\"", "data-axis=\"bytes a vertex then CPU seconds of a bake\"", "data-drawn=\"6 milliseconds a frame RMSE of the picture\"", "data-up=\"true\"", "data-down=\"true\"",
                            "data-empty=\"-\"", "data-requests=\"0\"", "data-fits=\"true\""})
    EXPECT_THAT(dom.substr(0, 1000), HasSubstr(state));
}

}  // namespace
}  // namespace chiaro
