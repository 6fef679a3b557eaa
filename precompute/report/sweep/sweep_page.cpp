#include "precompute/report/sweep/sweep_page.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "precompute/figure/html_text.h"
#include "precompute/report/page/page.h"
#include "precompute/report/page/page_texts.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// For people: what the JSON calls by one word.
std::string titleOf(SweepForm form) {
  switch (form) {
    case SweepForm::pca: return "SSDF PCA";
    case SweepForm::paper: return "SSDF PCA 48, Wang et al. 2009";
    default: return nameOf(form);
  }
}

std::string measureName(std::size_t measure) {
  if (measure == kWorst) return "worst of all sharpnesses";
  if (measure == kPicture) return "of the picture";
  char text[32];
  std::snprintf(text, sizeof text, "sharpness %g", kLobeSharpness[measure]);
  return text;
}

std::string chartData(const SweepStudy& study) {
  Json points = Json::array(), fronts = Json::object();
  for (const auto& result : study.results) {
    Json error = Json::object();
    for (const auto place : {SweepPlace::vertices, SweepPlace::triangles}) {
      Json all = Json::array();
      for (std::size_t measure = 0; measure <= kPicture; ++measure) all.push_back(number(errorOf(result, place, measure)));
      error[place == SweepPlace::vertices ? "vertices" : "triangles"] = std::move(all);
    }
    points.push_back({{"form", titleOf(result.point.form)},
                      {"label", labelOf(result.point)},
                      {"bytes_per_vertex", number(result.figures.bytesPerVertex)},
                      {"cpu_seconds", number(result.figures.cpuSeconds)},
                      {"frame_ms", number(result.figures.frameMilliseconds)},
                      {"error", std::move(error)}});
  }
  for (const auto place : {SweepPlace::vertices, SweepPlace::triangles}) {
    Json byMeasure = Json::array();
    for (std::size_t measure = 0; measure <= kPicture; ++measure)
      byMeasure.push_back({{"bytes_per_vertex", frontOf(study.results, place, measure, SweepCost::bytesPerVertex)},
                           {"cpu_seconds", frontOf(study.results, place, measure, SweepCost::cpuSeconds)},
                           {"frame_ms", frontOf(study.results, place, measure, SweepCost::frameMilliseconds)}});
    fronts[place == SweepPlace::vertices ? "vertices" : "triangles"] = std::move(byMeasure);
  }
  return Json{{"points", std::move(points)}, {"fronts", std::move(fronts)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string select(const std::string& id, const std::string& label, const std::vector<std::pair<std::string, std::string>>& choices) {
  std::string html = "<label>" + label + " <select id=\"" + id + "\" autocomplete=\"off\">";
  for (const auto& [value, text] : choices) html += "<option value=\"" + value + "\">" + htmlText(text) + "</option>";
  return html + "</select></label>\n";
}

std::string controls(bool triangles, bool drawn) {
  std::vector<std::pair<std::string, std::string>> measures{{std::to_string(kWorst), measureName(kWorst)}};
  for (std::size_t measure = 0; measure < kWorst; ++measure) measures.emplace_back(std::to_string(measure), measureName(measure));
  std::vector<std::pair<std::string, std::string>> costs{{"bytes_per_vertex", "bytes a vertex"}, {"cpu_seconds", "CPU seconds of a bake"}};
  if (drawn) {
    measures.emplace_back(std::to_string(kPicture), measureName(kPicture));
    costs.emplace_back("frame_ms", "frame time");
  }
  std::vector<std::pair<std::string, std::string>> places{{"vertices", "at vertices"}};
  if (triangles) places.emplace_back("triangles", "inside triangles");
  return "<div class=\"controls\">" + select("cost", "cost", costs) +
         select("measure", "error", measures) + select("place", "measured", places) + "</div>\n";
}

std::string frontsOf(std::initializer_list<std::pair<bool, const char*>> fronts) {
  std::string text;
  for (const auto& [on, name] : fronts)
    if (on) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::string choice(const SweepStudy& study) {
  if (!study.targets()) return "";
  if (!study.chosen) return "<p class=\"bad\">No setting is within the targets.</p>\n";
  const auto& point = study.results[*study.chosen].point;
  return "<p>Within the targets: <b>" + htmlText(labelOf(point)) + "</b></p>\n<pre class=\"wide\">" + htmlText(commandsOf(point, study.scene)) + "</pre>\n";
}

std::string resultTable(const SweepStudy& study) {
  const auto bytes = frontOf(study.results, SweepPlace::vertices, kWorst, SweepCost::bytesPerVertex);
  const auto seconds = frontOf(study.results, SweepPlace::vertices, kWorst, SweepCost::cpuSeconds);
  const auto frames = frontOf(study.results, SweepPlace::vertices, kPicture, SweepCost::frameMilliseconds);
  std::vector<std::string> heads{"setting", "bytes a vertex", "CPU seconds", "worst error", "worst inside", "frame ms", "picture RMSE", "front"};
  for (std::size_t measure = 0; measure < kWorst; ++measure) heads.push_back(measureName(measure));
  std::vector<TableRow> rows;
  for (std::size_t i = 0; i < study.results.size(); ++i) {
    const auto& result = study.results[i];
    TableRow row{.cells = {textCell(labelOf(result.point)), numberCell("%.1f", result.figures.bytesPerVertex), numberCell("%.1f", result.figures.cpuSeconds),
                           numberCell("%.4f", errorOf(result, SweepPlace::vertices, kWorst)), numberCell("%.4f", errorOf(result, SweepPlace::triangles, kWorst)),
                           numberCell("%.2f", result.figures.frameMilliseconds), numberCell("%.4f", result.figures.pictureRmse), textCell(frontsOf({{bytes[i], "bytes"}, {seconds[i], "time"}, {frames[i], "frame"}}))},
                 .look = bytes[i] || seconds[i] || frames[i] ? "front" : "dominated"};
    for (std::size_t measure = 0; measure < kWorst; ++measure) row.cells.push_back(numberCell("%.4f", errorOf(result, SweepPlace::vertices, measure)));
    rows.push_back(std::move(row));
  }
  return sortableTable("points", heads, rows);
}

}  // namespace

std::string sweepPage(const SweepStudy& study, const std::string& version) {
  const auto& measure = study.measure;
  std::string body =
      "<p>What each setting of a bake costs and buys. The error is the mean difference of the visible fraction of lobes from traced rays, " +
      std::to_string(measure.vertices) + " random vertices" + (measure.points > 0 ? " and " + std::to_string(measure.points) + " points inside triangles" : "") +
      ", 16 axes each, " + std::to_string(measure.rays) + " rays a lobe. A faint point is dominated: another costs no more and errs no more.</p>\n";
  body += choice(study) + controls(measure.points > 0, !study.glRenderer.empty()) + "<div class=\"chart\"><canvas id=\"chart\" role=\"img\" aria-label=\"Error against cost; the same figures are in the table below\"></canvas></div>\n";
  body += "<h2>All settings</h2>\n<p class=\"soft\">Errors at vertices but for \"worst inside\" (triangles). A click on a head sorts. What is not a bake has no bake time and is not drawn.</p>\n" + resultTable(study);
  body += "<p class=\"soft\">" + htmlText(study.scene) + (study.ground ? " over a ground" : "") + ", " + std::to_string(study.facts.vertices) + " vertices, " +
          std::to_string(study.facts.triangles) + " triangles. " +
          (study.glRenderer.empty() ? std::string()
                                    : "Frames: " + htmlText(study.drawn.environment) + ", " + std::to_string(study.drawn.size.x) + " x " + std::to_string(study.drawn.size.y) + " on " +
                                          htmlText(study.glRenderer) + "; the picture's error is the RMSE of what the screen shows. ") +
          "chiaro-report " + htmlText(version) + ".</p>\n";
  return pageHtml({.title = "What a bake costs and buys: " + study.scene, .body = body, .data = chartData(study), .scripts = {chartLibrary(), sweepScript()}});
}

}  // namespace chiaro
