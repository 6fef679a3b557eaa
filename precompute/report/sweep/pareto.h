#pragma once
/// Which settings are worth having.

#include <vector>

namespace chiaro {

/// Whether each point is on the front: no other costs no more and errs no more, and is better in one of both. Of equal points all are. A point whose cost or
/// error is not finite is not on it, and dominates none.
std::vector<bool> paretoFront(const std::vector<double>& cost, const std::vector<double>& error);

}  // namespace chiaro
