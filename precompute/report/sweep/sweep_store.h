#pragma once
/// The finished points of a sweep in one file of JSON lines: a sweep that was stopped or killed goes on from it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "precompute/report/sweep/sweep_point.h"

namespace chiaro {

class SweepStore {
 public:
  /// Opens or makes the file, and reads the results whose key is `key`: scene, program and measurement as one text. Lines of another key stay as they are;
  /// what a kill tore off at the end is cut off. Throws Error (unwritableOutput): it cannot be made, or another sweep has it open.
  SweepStore(std::filesystem::path path, std::string key);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// What is known of this setting.
  std::optional<SweepResult> find(const SweepPoint& point) const;

  /// One write, flushed to disk. Throws Error (unwritableOutput).
  void append(const SweepResult& result);

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::string key_;
  int descriptor_ = -1;
  std::vector<SweepResult> results_;
};

}  // namespace chiaro
