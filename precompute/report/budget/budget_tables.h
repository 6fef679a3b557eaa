#pragma once
/// A budget for people and machines.

#include <optional>
#include <string>

#include "precompute/report/budget/budget.h"
#include "precompute/report/budget/error_view.h"
#include "precompute/report/budget/image_budget.h"

namespace chiaro {

struct BudgetStudy {
  std::string scene;  ///< as the user named it
  bool ground = false;
  VisibilitySettings measure;
  Budget budget;
  ImageBudgetSettings drawn;
  std::optional<ImageBudget> pictures;
  std::optional<ErrorView> view;
};

std::string budgetTable(const BudgetStudy& study);
/// Field names: docs/programs.md. Figures that are not defined are null.
std::string budgetJson(const BudgetStudy& study, const std::string& version);
/// One line for each place and stage.
std::string budgetCsv(const BudgetStudy& study);
std::string budgetPage(const BudgetStudy& study, const std::string& version);

}  // namespace chiaro
