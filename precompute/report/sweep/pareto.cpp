#include "precompute/report/sweep/pareto.h"

#include <cmath>

namespace chiaro {

std::vector<bool> paretoFront(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<bool> front(cost.size());
  for (std::size_t i = 0; i < cost.size(); ++i) {
    front[i] = std::isfinite(cost[i]) && std::isfinite(error[i]);
    for (std::size_t j = 0; j < cost.size() && front[i]; ++j)
      if (cost[j] <= cost[i] && error[j] <= error[i] && (cost[j] < cost[i] || error[j] < error[i])) front[i] = false;
  }
  return front;
}

}  // namespace chiaro
