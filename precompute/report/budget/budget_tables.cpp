#include "precompute/report/budget/budget_tables.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "precompute/figure/html_text.h"
#include "precompute/report/budget/image_tables.h"
#include "precompute/report/page/page.h"
#include "precompute/report/page/page_texts.h"
#include "precompute/report/visibility/lobe_truth.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;
using Place = ErrorBySharpness BudgetStage::*;

struct NamedPlace {
  const char* id;
  const char* title;
  Place place;
};

std::vector<NamedPlace> placesOf(const BudgetStudy& study) {
  std::vector<NamedPlace> places{{"vertices", "at vertices", &BudgetStage::atVertices}};
  if (study.measure.points > 0) places.push_back({"triangles", "inside triangles", &BudgetStage::inTriangles});
  return places;
}

Json numbers(const ErrorBySharpness& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return json;
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string line(const std::string& name, const ErrorBySharpness& values, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, "  %-28s", name.c_str());
  std::string all = text;
  for (const double value : values) {
    std::snprintf(text, sizeof text, format, value);
    all += text;
  }
  return all + "\n";
}

std::string placeTable(const BudgetStudy& study, const NamedPlace& where) {
  std::vector<std::string> heads{"cause"};
  for (const double sharpness : kLobeSharpness) heads.push_back(formatted("%g", sharpness));
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& name, const ErrorBySharpness& values, const char* format, const char* look) {
    TableRow row{.cells = {textCell(name)}, .look = look};
    for (const double value : values) row.cells.push_back(numberCell(format, value));
    rows.push_back(std::move(row));
  };
  const auto& stages = study.budget.stages;
  for (std::size_t i = 0; i < stages.size(); ++i) add(stages[i].cause, causedBy(study.budget, i, where.place), "%+.4f", "");
  add("together: the bake", stages.front().*where.place, "%.4f", "front");
  return "<h2>Errors " + std::string(where.title) + ", by sharpness</h2>\n" + sortableTable(where.id, heads, rows);
}

std::string worstTable(const Budget& budget) {
  std::vector<TableRow> rows;
  for (const auto& one : budget.worst)
    rows.push_back({.cells = {textCell(one.atVertex ? "vertex" : "inside a triangle"), numberCell("%.0f", static_cast<double>(one.vertex)), numberCell("%.4g", one.position.x),
                              numberCell("%.4g", one.position.y), numberCell("%.4g", one.position.z), numberCell("%.4f", one.error), numberCell("%.4f", one.worst),
                              numberCell("%g", one.worstSharpness)}});
  return "<h2>Where the bake errs most</h2>\n<p class=\"soft\">Of the measured points. Inside triangles the vertex is the nearest corner; positions in metres.</p>\n" +
         sortableTable("worst", {"point", "vertex", "x", "y", "z", "mean error", "largest", "at sharpness"}, rows);
}

}  // namespace

std::string budgetTable(const BudgetStudy& study) {
  const auto& budget = study.budget;
  std::string text = study.scene + ": " + std::to_string(budget.vertices) + " vertices, " + formatted("%.1f", budget.bytesPerVertex) + " bytes each, " +
                     std::to_string(budget.functions) + " functions, " + std::to_string(budget.clusters) + " clusters\n";
  for (const auto& where : placesOf(study)) {
    text += "\nmean |error| of the visible fraction " + std::string(where.title) + ", by sharpness\n";
    ErrorBySharpness head{};
    for (std::size_t s = 0; s < head.size(); ++s) head[s] = kLobeSharpness[s];
    text += line("", head, "%9g");
    for (const auto& stage : budget.stages) text += line(stage.what, stage.*where.place, "%9.4f");
    text += "of these are\n";
    for (std::size_t i = 0; i < budget.stages.size(); ++i) text += line(budget.stages[i].cause, causedBy(budget, i, where.place), "%+9.4f");
  }
  text += "\n" + line("noise of the truth", budget.truthNoise, "%9.4f");
  return study.pictures ? text + "\n" + imageBudgetTable(*study.pictures) : text;
}

std::string budgetJson(const BudgetStudy& study, const std::string& version) {
  const auto& budget = study.budget;
  const auto& measure = study.measure;
  Json json{{"program", "chiaro-report budget"},
            {"version", version},
            {"scene", study.scene},
            {"ground", study.ground},
            {"vertices", budget.vertices},
            {"triangles", budget.triangles},
            {"settings", {{"vertices", measure.vertices}, {"points", measure.points}, {"rays", measure.rays}, {"axes", LobeTruth::kAxes}, {"seed", measure.seed}}},
            {"bytes_per_vertex", budget.bytesPerVertex},
            {"functions", budget.functions},
            {"clusters", budget.clusters},
            {"sharpness", kLobeSharpness},
            {"truth_noise", numbers(budget.truthNoise)},
            {"stages", Json::array()}};
  for (std::size_t i = 0; i < budget.stages.size(); ++i) {
    Json stage{{"what", budget.stages[i].what}, {"cause", budget.stages[i].cause}};
    for (const auto& where : placesOf(study)) {
      stage[std::string("error_") + where.id] = numbers(budget.stages[i].*where.place);
      stage[std::string("caused_") + where.id] = numbers(causedBy(budget, i, where.place));
    }
    json["stages"].push_back(std::move(stage));
  }
  json["worst_points"] = Json::array();
  for (const auto& one : budget.worst)
    json["worst_points"].push_back({{"at_vertex", one.atVertex}, {"vertex", one.vertex}, {"position", {one.position.x, one.position.y, one.position.z}}, {"error", one.error},
                                    {"largest", one.worst}, {"largest_at_sharpness", one.worstSharpness}});
  json["vertex_error"] = nullptr;
  json["worst_vertices"] = Json::array();
  if (study.view) {
    json["vertex_error"] = {{"mean", study.view->errors.mean}, {"median", study.view->errors.median}, {"percentile_95", study.view->errors.percentile95}};
    for (const auto& [vertex, at, closeUp] : study.view->worst)
      json["worst_vertices"].push_back({{"vertex", vertex.vertex}, {"mesh", vertex.mesh}, {"position", {vertex.position.x, vertex.position.y, vertex.position.z}}, {"error", vertex.error}});
  }
  json["pictures"] = study.pictures ? imageBudgetJson(*study.pictures, study.drawn) : Json(nullptr);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string budgetCsv(const BudgetStudy& study) {
  std::ostringstream csv;
  csv.precision(9);
  csv << "place,what,cause";
  for (const char* kind : {"error", "caused"})
    for (const double sharpness : kLobeSharpness) csv << ',' << kind << '_' << sharpness;
  csv << '\n';
  for (const auto& where : placesOf(study))
    for (std::size_t i = 0; i < study.budget.stages.size(); ++i) {
      const auto& stage = study.budget.stages[i];
      csv << where.id << ',' << stage.what << ',' << stage.cause;
      for (const auto& values : {stage.*where.place, causedBy(study.budget, i, where.place)})
        for (const double value : values) {
          csv << ',';
          if (std::isfinite(value)) csv << value;
        }
      csv << '\n';
    }
  return csv.str();
}

std::string budgetPage(const BudgetStudy& study, const std::string& version) {
  const auto& budget = study.budget;
  Json data{{"sharpness", kLobeSharpness}, {"places", Json::array()}};
  std::string charts, tables;
  for (const auto& where : placesOf(study)) {
    Json causes = Json::array();
    for (std::size_t i = 0; i < budget.stages.size(); ++i) causes.push_back({{"name", budget.stages[i].cause}, {"error", numbers(causedBy(budget, i, where.place))}});
    data["places"].push_back({{"id", where.id}, {"causes", std::move(causes)}});
    charts += "<figure><h2>" + std::string(where.title) + "</h2><div class=\"chart\"><canvas id=\"chart_" + where.id +
              "\" role=\"img\" aria-label=\"Error by cause; the same figures are in the table below\"></canvas></div></figure>\n";
    tables += placeTable(study, where);
  }
  std::string body =
      "<p>Which stage of a bake causes which part of its error. One stage after another is replaced by its exact form; what the error falls by is that stage's "
      "share, so all shares add up to the error of the bake. A share below zero: that stage hides a part of another's error. Mean difference of the visible "
      "fraction of lobes from traced rays, " +
      std::to_string(study.measure.vertices) + " random vertices" + (study.measure.points > 0 ? " and " + std::to_string(study.measure.points) + " points inside triangles" : "") +
      ", 16 axes each.</p>\n<div class=\"row\">\n" + charts + "</div>\n" + tables + worstTable(budget);
  if (study.view) body += errorViewSection(*study.view);
  if (study.pictures) {
    body += imageBudgetSection(*study.pictures, study.drawn);
    data["pictures"] = imageBudgetChart(*study.pictures);
  }
  body += "<p class=\"soft\">" + htmlText(study.scene) + (study.ground ? " over a ground" : "") + ", " + std::to_string(budget.vertices) + " vertices, " +
          formatted("%.1f", budget.bytesPerVertex) + " bytes each, " + std::to_string(budget.functions) + " functions, " + std::to_string(budget.clusters) +
          " clusters. chiaro-report " + htmlText(version) + ".</p>\n";
  return pageHtml({.title = "Where a bake is wrong: " + study.scene, .body = body, .data = data.dump(), .scripts = {chartLibrary(), budgetScript()}});
}

}  // namespace chiaro
