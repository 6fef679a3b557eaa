#include "precompute/report/sweep/sweep_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <sstream>

#include "assets/error.h"
#include "assets/file.h"

namespace chiaro {

SweepStore::SweepStore(std::filesystem::path path, std::string key) : path_(std::move(path)), key_(std::move(key)) {
  descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(std::strerror(errno));
  try {
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) throw outputError(path_.string(), "another sweep has it open", "wait for it, or give another folder");
    const auto bytes = readFile(path_);
    const std::string text(bytes.begin(), bytes.end());
    const auto whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
    if (whole < text.size() && ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) fail(std::strerror(errno));
    std::istringstream lines(text.substr(0, whole));
    for (std::string line; std::getline(lines, line);)
      if (const auto result = parseResultLine(line, key_)) results_.push_back(*result);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

SweepStore::~SweepStore() { close(descriptor_); }

void SweepStore::fail(const std::string& what) const { throw outputError(path_.string(), "cannot be written: " + what, "give another folder with -o"); }

std::optional<SweepResult> SweepStore::find(const SweepPoint& point) const {
  for (const auto& result : results_)
    if (result.point == point) return result;
  return {};
}

void SweepStore::append(const SweepResult& result) {
  const std::string line = resultLine(key_, result) + "\n";
  const auto written = write(descriptor_, line.data(), line.size());
  if (written < 0) fail(std::strerror(errno));
  if (static_cast<std::size_t>(written) != line.size()) fail("the disk is full");
  if (fdatasync(descriptor_) != 0) fail(std::strerror(errno));
  results_.push_back(result);
}

}  // namespace chiaro
