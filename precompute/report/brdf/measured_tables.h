#pragma once
/// Measured materials for people and machines.

#include <nlohmann/json.hpp>
#include <string>

#include "precompute/report/brdf/measured_study.h"

namespace chiaro {

std::string measuredTable(const MeasuredStudy& study);
nlohmann::ordered_json measuredJson(const MeasuredStudy& study);
/// Two tables, without the figures.
std::string measuredHtml(const MeasuredStudy& study);

}  // namespace chiaro
