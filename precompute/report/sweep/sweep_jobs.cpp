// Bakes by processes of this program: each has its own memory, threads and processor time, and a crash of one is its own.

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <thread>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/parallel.h"
#include "precompute/report/report_folder.h"
#include "precompute/report/sweep/sweep_bakes.h"

extern char** environ;

namespace chiaro {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(20);

/// Bytes that other programs leave; 0 where the system does not say.
double freeBytes() {
  std::ifstream file("/proc/meminfo");
  for (std::string name; file >> name;) {
    double kibibytes = 0.0;
    if (name == "MemAvailable:" && file >> kibibytes) return 1024.0 * kibibytes;
    file.ignore(256, '\n');
  }
  return 0.0;
}

/// Of one bake: a sample of 8192 rows in floats and twice as much to work on them, or every row of a pca, and what each vertex takes.
double bytesOf(const SweepPoint& point, std::size_t vertices) {
  constexpr double kSample = 8192.0, kProgram = 200e6, kVertex = 700.0;
  const double texels = static_cast<double>(point.resolution) * point.resolution, count = static_cast<double>(vertices);
  if (point.form == SweepForm::pca) return kProgram + count * (2.0 * texels + kVertex);
  return kProgram + 12.0 * std::min(kSample, count) * 1.75 * texels + count * (2.0 * 1024.0 + kVertex);
}

class Children {
 public:
  ~Children() {
    for (const auto& [pid, place] : running_) ::kill(pid, SIGTERM);
    for (const auto& [pid, place] : running_) ::waitpid(pid, nullptr, 0);
  }
  std::size_t count() const { return running_.size(); }

  void start(std::size_t place, std::vector<std::string> arguments, const std::filesystem::path& messages) {
    std::vector<char*> pointers;
    for (auto& word : arguments) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t pid = 0;
    const int failure = posix_spawn(&pid, "/proc/self/exe", &files, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) throw Error(ExitCode::failed, "--jobs", std::string("a process cannot be started: ") + std::strerror(failure), "give --jobs 1");
    running_[pid] = place;
  }

  /// The place and status of one that has ended; nothing where all go on.
  std::optional<std::pair<std::size_t, int>> ended() {
    for (const auto& [pid, place] : running_) {
      int status = 0;
      if (::waitpid(pid, &status, WNOHANG) != pid) continue;
      const std::pair result{place, status};
      running_.erase(pid);
      return result;
    }
    return {};
  }

 private:
  std::map<pid_t, std::size_t> running_;
};

[[noreturn]] void failedBake(const SweepPoint& point, int status, const std::filesystem::path& messages) {
  std::string said;
  try {
    const auto bytes = readFile(messages);
    said.assign(bytes.begin(), bytes.end());
  } catch (const Error&) {
  }
  said = said.substr(0, said.find('\n'));
  if (const std::string name = "chiaro-report: "; said.starts_with(name)) said.erase(0, name.size());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  if (said.empty()) said = WIFSIGNALED(status) ? std::string("ended by signal ") + strsignal(WTERMSIG(status)) : "ended with exit code " + std::to_string(code);
  throw Error(static_cast<ExitCode>(code == 0 ? 1 : code), "bake of " + labelOf(point), said, "give --jobs 1 to see it alone");
}

}  // namespace

int jobsThatFit(const std::vector<SweepPoint>& points, std::size_t vertices, int threads) {
  double largest = 1.0;
  for (const auto& point : points)
    if (point.isBake()) largest = std::max(largest, bytesOf(point, vertices));
  return std::clamp(static_cast<int>(freeBytes() / largest), 1, threadCount(threads));
}

void bakeInParallel(const SweepBakes& bakes, const std::vector<SweepPoint>& points, const std::vector<std::size_t>& wanted, int jobs, int threads, const std::vector<std::string>& arguments,
                    const ProgressHandler& progress) {
  std::vector<std::size_t> waiting;
  for (const auto place : wanted) {
    const bool known = std::any_of(waiting.begin(), waiting.end(), [&](std::size_t other) { return bakeOf(points[other]) == bakeOf(points[place]); });
    if (!known && !bakes.isStored(points[place])) waiting.push_back(place);
  }
  if (waiting.empty()) return;
  makeFolder(bakes.folder());
  const auto all = waiting.size();
  const int each = std::max(1, threadCount(threads) / jobs);
  Children children;
  std::size_t next = 0, done = 0;
  while (done < all) {
    progress("bakes", static_cast<double>(done) / static_cast<double>(all));
    while (next < all && children.count() < static_cast<std::size_t>(jobs)) {
      auto words = arguments;
      for (const auto& word : {std::string("--bake-point"), std::to_string(waiting[next]), std::string("--bake-threads"), std::to_string(each)}) words.push_back(word);
      children.start(waiting[next], std::move(words), bakes.messages(points[waiting[next]]));
      ++next;
    }
    if (const auto ended = children.ended()) {
      const auto& point = points[ended->first];
      if (ended->second != 0 || !bakes.isStored(point)) failedBake(point, ended->second, bakes.messages(point));
      ++done;
    } else {
      std::this_thread::sleep_for(kPoll);
    }
  }
}

}  // namespace chiaro
