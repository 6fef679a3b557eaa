#pragma once
/// Figures of a report for people and machines.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "precompute/figure/figure.h"

namespace chiaro {

/// Each with `id`, `title`, `x`, `y` (what the axes are) and `curves` (`name`, `x`, `y`); values that are not finite are null.
nlohmann::ordered_json figuresJson(const std::vector<Figure>& figures);
/// A line for each point; values that are not finite are empty.
std::string figuresCsv(const std::vector<Figure>& figures);
/// Figure elements with their titles and notes.
std::string figuresHtml(const std::vector<Figure>& figures);

}  // namespace chiaro
