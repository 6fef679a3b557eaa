#include "precompute/report/brdf/brdf_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "precompute/figure/html_text.h"
#include "precompute/report/page/figures.h"
#include "precompute/report/brdf/measured_tables.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number(value));
  return json;
}

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string padded(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ground:#fff;--text:#1c1c1c;--soft:#666;--line:#ddd;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--ground:#141414;--text:#e6e6e6;--soft:#a0a0a0;--line:#383838;--bad:#ff8a80}}
body{margin:0 auto;padding:1rem;max-width:84rem;background:var(--ground);color:var(--text);font:16px/1.5 system-ui,sans-serif}
h1{font-size:1.4rem;margin:.5rem 0}h2{font-size:1.1rem;margin:2rem 0 .5rem}p{max-width:46rem}
.soft,figcaption{color:var(--soft);font-size:.9rem}.bad{color:var(--bad);font-weight:600}
.wide{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .7rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left}
.row{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,34rem),1fr));gap:1.5rem}
figure{margin:0}figure h2{margin:.5rem 0}svg{width:100%;height:auto;display:block}svg text{fill:var(--text);font:12px system-ui,sans-serif}
.grid{stroke:var(--line);stroke-width:1}
)";

struct Column {
  const char* title;
  double ModelError::*value;
};
constexpr Column kColumns[] = {{"1 lobe, isotropic warp", &ModelError::paper},   {"ours", &ModelError::ours},
                               {"worst view", &ModelError::worstView},           {"ours, all views", &ModelError::oursAllViews},
                               {"256 factored terms", &ModelError::factored256}, {"limit", &ModelError::limit}};

}  // namespace

std::string brdfTable(const BrdfStudy& study) {
  std::string text = "squared relative error, equation (11); views to 75 degrees unless said\n" + padded("model", 14) +
                     padded("m, alpha, n", 13);
  for (const Column& column : kColumns) text += padded(column.title, 24);
  text += "\n";
  for (const ModelError& e : study.models) {
    text += padded(e.model, 14) + padded(formatted("%g", e.parameter), 13);
    for (const Column& column : kColumns) text += padded(formatted("%.2e", e.*column.value), 24);
    text += e.holds() ? "\n" : "  over\n";
  }
  text += "\nelongated models as lobes strung over light directions (GGX: three strings)\n" + padded("model", 18) +
          padded("x", 9) + padded("y", 9);
  for (const int count : ElongatedError::kCounts) text += padded(std::to_string(count) + " lobes", 12);
  text += padded("GGX as drawn", 14) + "\n";
  for (const ElongatedError& e : study.elongated) {
    text += padded(e.model, 18) + padded(formatted("%g", e.x), 9) + padded(formatted("%g", e.y), 9);
    for (const double error : e.byCount) text += padded(formatted("%.2e", error), 12);
    text += padded(formatted("%.2e", e.drawn), 14) + "\n";
  }
  if (!study.measured.empty()) text += measuredTable(study.measured);
  return text;
}

std::string brdfJson(const BrdfStudy& study, const std::string& version) {
  Json json;
  json["program"] = "chiaro-report brdf";
  json["version"] = version;
  json["quick"] = study.quick;
  json["seconds"] = study.seconds;
  json["models"] = Json::array();
  for (const ModelError& e : study.models)
    json["models"].push_back({{"model", e.model},
                              {"parameter", e.parameter},
                              {"one_lobe_isotropic_75", number(e.paper)},
                              {"ours_75", number(e.ours)},
                              {"worst_view_75", number(e.worstView)},
                              {"worst_view_degrees", e.worstAngle},
                              {"ours_all_views", number(e.oursAllViews)},
                              {"factored_256_75", number(e.factored256)},
                              {"limit", number(e.limit)},
                              {"below_factored_256_wanted", e.below256Wanted},
                              {"holds", e.holds()}});
  json["elongated"] = Json::array();
  for (const ElongatedError& e : study.elongated)
    json["elongated"].push_back({{"model", e.model},
                                 {"x", e.x},
                                 {"y", e.y},
                                 {"lobes", ElongatedError::kCounts},
                                 {"error_75", numbers({e.byCount.begin(), e.byCount.end()})},
                                 {"drawn_75", number(e.drawn)}});
  if (!study.measured.empty()) json["measured"] = measuredJson(study.measured);
  json["figures"] = figuresJson(study.figures);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string brdfCsv(const BrdfStudy& study) { return figuresCsv(study.figures); }

std::string brdfPage(const BrdfStudy& study, const std::string& version) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">\n"
      "<title>Reflectance as spherical Gaussians</title><style>" +
      std::string(kStyle) + "</style></head><body>\n<h1>Reflectance as spherical Gaussians</h1>\n";
  html +=
      "<p>How well a few spherical Gaussians stand for each reflectance model, beside factorisation into products of a function "
      "of light and one of view. "
      "The error is equation (11) of the supplement of Wang et al. 2009: squared, weighted by both cosines, over both "
      "hemispheres, relative to the square of the truth. "
      "Reflectances are without Fresnel.</p>\n<div class=\"row\">\n";
  html += figuresHtml(study.figures);
  html +=
      "</div>\n<h2>Equation (11), distribution, smooth factor and warp together</h2>\n<p class=\"soft\">Views from the normal to "
      "75 degrees unless said. Ours: the fitted lobes that a "
      "shader reads, nine (GGX: sixteen).</p>\n<div class=\"wide\"><table><tr><th>model</th><th>m, alpha, n</th>";
  for (const Column& column : kColumns) html += "<th>" + std::string(column.title) + "</th>";
  html += "</tr>\n";
  for (const ModelError& e : study.models) {
    html += "<tr><td>" + htmlText(e.model) + "</td><td>" + formatted("%g", e.parameter) + "</td>";
    for (const Column& column : kColumns)
      html += (column.value == &ModelError::ours && !e.holds() ? "<td class=\"bad\">" : "<td>") +
              formatted("%.2g", e.*column.value) +
              (column.value == &ModelError::worstView ? " (" + formatted("%g", e.worstAngle) + "&deg;)" : "") + "</td>";
    html += "</tr>\n";
  }
  html +=
      "</table></div>\n<h2>Elongated models</h2>\n<p class=\"soft\">Lobes strung over light directions, fitted to the "
      "reflectance at their axes; GGX takes three strings, and is drawn by longer ones. Views to 75 "
      "degrees.</p>\n<div class=\"wide\"><table><tr><th>model</th><th>x</th><th>y</th>";
  for (const int count : ElongatedError::kCounts) html += "<th>" + std::to_string(count) + " lobes</th>";
  html += "<th>GGX as drawn</th>";
  html += "</tr>\n";
  for (const ElongatedError& e : study.elongated) {
    html += "<tr><td>" + htmlText(e.model) + "</td><td>" + formatted("%g", e.x) + "</td><td>" + formatted("%g", e.y) + "</td>";
    for (const double error : e.byCount) html += "<td>" + formatted("%.2g", error) + "</td>";
    html += "<td>" + formatted("%.2g", e.drawn) + "</td>";
    html += "</tr>\n";
  }
  html += "</table></div>\n";
  if (!study.measured.empty()) html += measuredHtml(study.measured);
  html += "<p class=\"soft\">chiaro-report " + htmlText(version) + (study.quick ? ", quick: coarse" : "") + ", " +
          formatted("%.0f", study.seconds) + " s.</p>\n";
  return html + "</body></html>\n";
}

}  // namespace chiaro
