#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "precompute/figure/html_text.h"
#include "precompute/report/page/page.h"
#include "precompute/report/page/page_texts.h"
#include "precompute/report/stability/stability.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string inputsText(const StabilityFigures& figures) {
  std::string text;
  for (const float value : figures.worstInputs) text += (text.empty() ? "" : ", ") + formatted("%.9g", static_cast<double>(value));
  return text;
}

Json figuresJson(const StabilityFigures& figures) {
  // NaN and infinities are inputs like any other, and JSON has no numbers for them.
  Json inputs = Json::array();
  for (const float value : figures.worstInputs) inputs.push_back(std::isfinite(value) ? Json(value) : Json(formatted("%g", static_cast<double>(value))));
  return {{"median", number(figures.median)}, {"percentile_99", number(figures.percentile99)}, {"worst", number(figures.worst)}, {"worst_ulps", number(figures.worstUlps)},
          {"worst_inputs", std::move(inputs)}, {"failures", figures.failures}};
}

}  // namespace

std::string stabilityTable(const StabilityStudy& study) {
  std::string text = "worst relative error against double" + (study.renderer.empty() ? std::string() : ", GLSL on " + study.renderer) + "\n\n";
  char line[200];
  std::snprintf(line, sizeof line, "%-28s%12s%10s%12s%10s\n", "function", "float C++", "ULPs", "GLSL", "ULPs");
  text += line;
  for (const auto& one : study.functions) {
    std::snprintf(line, sizeof line, "%-28s%12.2e%10.1f", one.name.c_str(), one.cpp.worst, one.cpp.worstUlps);
    text += line;
    if (one.glsl) {
      std::snprintf(line, sizeof line, "%12.2e%10.1f", one.glsl->worst, one.glsl->worstUlps);
      text += line;
    }
    text += one.cpp.failures + (one.glsl ? one.glsl->failures : 0) > 0 ? "  over tolerance\n" : "\n";
  }
  return text;
}

std::string stabilityJson(const StabilityStudy& study, const std::string& version) {
  Json json{{"program", "chiaro-report stability"}, {"version", version}, {"gl_renderer", study.renderer.empty() ? Json(nullptr) : Json(study.renderer)}, {"functions", Json::array()}};
  for (const auto& one : study.functions)
    json["functions"].push_back({{"name", one.name}, {"domain", one.domain}, {"samples", one.samples}, {"tolerance", one.tolerance}, {"float", figuresJson(one.cpp)},
                                 {"glsl", one.glsl ? figuresJson(*one.glsl) : Json(nullptr)}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string stabilityPage(const StabilityStudy& study, const std::string& version) {
  Json data{{"functions", Json::array()}, {"tolerance", Json::array()}, {"float", Json::array()}, {"glsl", Json::array()}};
  std::vector<TableRow> rows;
  for (const auto& one : study.functions) {
    data["functions"].push_back(one.name);
    data["tolerance"].push_back(one.tolerance);
    data["float"].push_back(number(one.cpp.worst));
    TableRow row{.cells = {textCell(one.name), numberCell("%.2e", one.cpp.worst, one.cpp.failures > 0), numberCell("%.1f", one.cpp.worstUlps)}};
    if (one.glsl) {
      data["glsl"].push_back(number(one.glsl->worst));
      row.cells.push_back(numberCell("%.2e", one.glsl->worst, one.glsl->failures > 0));
      row.cells.push_back(numberCell("%.1f", one.glsl->worstUlps));
    }
    for (auto cell : {numberCell("%.1e", one.cpp.median), numberCell("%.1e", one.cpp.percentile99), numberCell("%.0f", static_cast<double>(one.samples)), textCell(one.domain), textCell(inputsText(one.cpp))})
      row.cells.push_back(cell);
    rows.push_back(std::move(row));
  }
  std::vector<std::string> heads{"function", "float C++, worst", "ULPs"};
  if (!study.renderer.empty()) heads.insert(heads.end(), {"GLSL, worst", "ULPs"});
  heads.insert(heads.end(), {"float, median", "float, 99 %", "samples", "domain", "inputs of the worst in float"});
  const auto height = std::to_string(6 + study.functions.size() * 3 / 2) + "rem";
  std::string body =
      "<p>Every function that shaders and C++ share, over the whole domain it promises to hold on, in float C++" + std::string(study.renderer.empty() ? "" : " and in GLSL on this machine's driver") +
      ", against the same text in double. Errors are relative to the length of the answer; ULPs are steps of a float of that size. The mark is the tolerance.</p>\n"
      "<div class=\"chart\" style=\"height:" + height + "\"><canvas id=\"chart\" role=\"img\" aria-label=\"Worst error of each function; the same figures are in the table below\"></canvas></div>\n"
      "<h2>All functions</h2>\n" + sortableTable("functions", heads, rows) + "<p class=\"soft\">" +
      (study.renderer.empty() ? "" : "OpenGL: " + htmlText(study.renderer) + ". ") + "chiaro-report " + htmlText(version) + ".</p>\n";
  return pageHtml({.title = "Stability of the shared functions", .body = body, .data = data.dump(), .scripts = {chartLibrary(), stabilityScript()}});
}

}  // namespace chiaro
