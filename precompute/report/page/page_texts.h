#pragma once
/// What every page of a report carries in itself, as text (cmake/EmbedText.cmake).

#include <string_view>

namespace chiaro {

std::string_view chartLibrary();  ///< Chart.js, MIT licence, its notice in its first lines
std::string_view pageStyle();
std::string_view pageScript();   ///< tables that sort, pictures with a slider
std::string_view sweepScript();   ///< the chart of a sweep
std::string_view budgetScript();  ///< the charts of a budget
std::string_view stabilityScript();

}  // namespace chiaro
