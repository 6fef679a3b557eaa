#pragma once
/// Warnings of a loader: each line once, however many primitives repeat it.

#include <set>
#include <string>

#include "assets/scene/load_scene.h"

namespace chiaro {

class Warnings {
 public:
  explicit Warnings(const WarningHandler& handler) : handler_(handler) {}

  void say(const std::string& line) {
    if (handler_ && said_.insert(line).second) handler_(line);
  }

 private:
  const WarningHandler& handler_;
  std::set<std::string> said_;
};

}  // namespace chiaro
