#pragma once
/// An image budget for people and machines.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "precompute/report/budget/image_budget.h"

namespace chiaro {

std::string imageBudgetTable(const ImageBudget& budget);
/// Field names: docs/programs.md.
nlohmann::ordered_json imageBudgetJson(const ImageBudget& budget, const ImageBudgetSettings& drawn);
/// One line a stage.
std::string imageBudgetCsv(const ImageBudget& budget);
/// A section of the budget's page, with its pictures; the chart's canvas is "chart_pictures".
std::string imageBudgetSection(const ImageBudget& budget, const ImageBudgetSettings& drawn);
/// For page/budget.js: names and values of the causes.
nlohmann::ordered_json imageBudgetChart(const ImageBudget& budget);

}  // namespace chiaro
