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

/// Three coarse bakes, and seven baselines unless `bakesAlone`, in a few seconds.
std::vector<std::string> quick(const std::string& folder, bool bakesAlone = false) {
  std::vector<std::string> all{"sweep", "builtin:sphere", "--ground", "-o", folder, "--vertices", "4", "--points-inside", "3", "--rays", "64", "--resolution", "16", "--bytes", "8,24"};
  if (bakesAlone) all.emplace_back("--no-baselines");
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
    run_ = runProgram("chiaro-report", quick("sweep_all"));
  }
  static Finished run_;
};

Finished FinishedSweep::run_;

TEST_F(FinishedSweep, WritesEverythingItSays) {
  ASSERT_EQ(run_.code, 0) << run_.err;
  const auto json = nlohmann::json::parse(textOf("sweep_all/sweep.json"));
  EXPECT_EQ(json["program"], "chiaro-report sweep");
  ASSERT_EQ(json["points"].size(), 2u + 1u + 7u);  // joint, pca, baselines
  std::vector<double> cost, error;
  std::vector<bool> front;
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
    // 2 % is what a bake promises of its bytes.
    if (point["form"] == "joint") {
      EXPECT_LE(cost.back(), 1.02 * point["bytes"].get<double>());
    }
  }
  EXPECT_EQ(front, paretoFront(cost, error));
  const std::string csv = textOf("sweep_all/sweep.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 10);
  EXPECT_THAT(run_.out, HasSubstr("10 points, 0 of them known before"));
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
  for (const char* state : {"data-inked=\"true\"", "data-points=\"10\"", "data-axis=\"bytes a vertex then CPU seconds of a bake\"", "data-up=\"true\"", "data-down=\"true\"",
                            "data-empty=\"-\"", "data-requests=\"0\"", "data-fits=\"true\""})
    EXPECT_THAT(dom.substr(0, 1000), HasSubstr(state));
}

}  // namespace
}  // namespace chiaro
