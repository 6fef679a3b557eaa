#include "runtime/render/frame_statistics.h"

#include <algorithm>

namespace chiaro {
namespace {

PassStatistics statisticsOf(const std::string& name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {name, values.front(), median, values.back()};
}

}  // namespace

std::vector<PassStatistics> passStatistics(const std::vector<FrameTimings>& frames) {
  std::vector<std::pair<std::string, std::vector<double>>> passes;
  for (const auto& frame : frames) {
    for (const auto& [name, milliseconds] : frame.passes) {
      auto found = std::find_if(passes.begin(), passes.end(), [&, &wanted = name](const auto& pass) { return pass.first == wanted; });
      if (found == passes.end()) found = passes.insert(passes.end(), {name, {}});
      found->second.push_back(milliseconds);
    }
  }
  std::vector<PassStatistics> statistics;
  for (auto& [name, values] : passes) statistics.push_back(statisticsOf(name, std::move(values)));
  return statistics;
}

}  // namespace chiaro
