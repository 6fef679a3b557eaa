#pragma once
/// Progress of long work on standard error: a bar with rate and time left on a terminal, plain lines otherwise.

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace chiaro {

enum class ProgressStyle { none, lines, bar };

/// `none` when quiet, else `bar` where standard error is a terminal, else `lines`.
ProgressStyle progressStyle(bool quiet);

/// Not thread safe: call it from one thread at a time.
class ProgressBar {
 public:
  explicit ProgressBar(ProgressStyle style, std::FILE* stream = stderr) : style_(style), stream_(stream) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// What the whole of a stage consists of, for the rate ("1200 vertices/s"); count 0: no rate is shown.
  void setItems(std::size_t count, std::string name);

  /// A new `stage` name starts a new bar. done in [0, 1]. Lines come at each new quarter, the bar at most ten times a second.
  void update(const std::string& stage, double done);

  /// Takes the bar off the terminal, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string rate(double done, double seconds) const;

  ProgressStyle style_;
  std::FILE* stream_;
  std::size_t items_ = 0;
  std::string itemName_;
  std::string stage_;
  Clock::time_point start_;
  Clock::time_point drawn_;
  int quarter_ = -1;
  bool visible_ = false;
};

}  // namespace chiaro
