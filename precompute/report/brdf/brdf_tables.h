#pragma once
/// The measurements of `chiaro-report brdf` for people and machines.

#include <string>

#include "precompute/report/brdf/brdf_study.h"

namespace chiaro {

/// Equation (11) by model and parameter, as text.
std::string brdfTable(const BrdfStudy& study);

/// Field names: docs/programs.md. Figures that are not defined are null.
std::string brdfJson(const BrdfStudy& study, const std::string& version);

/// One line for each point of each curve.
std::string brdfCsv(const BrdfStudy& study);

/// One page without anything outside it: every figure as SVG, and the table.
std::string brdfPage(const BrdfStudy& study, const std::string& version);

}  // namespace chiaro
