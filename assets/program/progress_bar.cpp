#include "assets/program/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace chiaro {
namespace {

std::string duration(double seconds) {
  char text[32];
  if (seconds < 99.5)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else if (seconds < 3600.0)
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60.0);
  else
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600.0);
  return text;
}

}  // namespace

ProgressStyle progressStyle(bool quiet) {
  if (quiet) return ProgressStyle::none;
  return ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::bar : ProgressStyle::lines;
}

void ProgressBar::setItems(std::size_t count, std::string name) {
  items_ = count;
  itemName_ = std::move(name);
}

std::string ProgressBar::rate(double done, double seconds) const {
  if (items_ == 0 || !(seconds > 0.0)) return {};
  char text[64];
  std::snprintf(text, sizeof text, "%.0f %s/s", done * static_cast<double>(items_) / seconds, itemName_.c_str());
  return text;
}

void ProgressBar::update(const std::string& stage, double done) {
  if (style_ == ProgressStyle::none) return;
  const auto now = Clock::now();
  if (stage != stage_) {
    clear();
    stage_ = stage;
    start_ = now;
    drawn_ = {};
    quarter_ = -1;
  }
  done = std::clamp(done, 0.0, 1.0);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = done > 0.0 ? seconds * (1.0 - done) / done : 0.0;
  const auto speed = rate(done, seconds);

  if (style_ == ProgressStyle::lines) {
    const int quarter = static_cast<int>(done * 4.0);
    if (quarter == quarter_) return;
    quarter_ = quarter;
    std::fprintf(stream_, "%s: %d %%, %s%s%s\n", stage.c_str(), static_cast<int>(std::lround(100.0 * done)), duration(seconds).c_str(),
                 speed.empty() ? "" : ", ", speed.c_str());
    return;
  }

  if (done < 1.0 && now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(done * kWidth);
  std::fprintf(stream_, "\r\x1b[K%-12s [%s%s] %3d %%  %s  %s left", stage.c_str(), std::string(static_cast<std::size_t>(filled), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), static_cast<int>(100.0 * done), speed.c_str(),
               duration(left).c_str());
  std::fflush(stream_);
  visible_ = true;
}

void ProgressBar::clear() {
  if (!visible_) return;
  std::fputs("\r\x1b[K", stream_);
  std::fflush(stream_);
  visible_ = false;
}

}  // namespace chiaro
