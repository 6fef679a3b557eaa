#include "precompute/report/visibility/visibility_page.h"

#include <cstdio>

#include "precompute/figure/html_text.h"
#include "precompute/report/page/figures.h"
#include "precompute/report/page/page.h"

namespace chiaro {
namespace {

std::string tableOf(const std::string& id, const std::string& title, const VisibilityComparison& comparison, ErrorBySharpness MethodError::*error) {
  std::vector<std::string> heads{"stored", "bytes a vertex"};
  for (const double sharpness : kLobeSharpness) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", sharpness);
    heads.emplace_back(text);
  }
  std::vector<TableRow> rows;
  for (const auto& method : comparison.methods) {
    TableRow row{.cells = {textCell(method.name), numberCell("%.1f", method.bytesPerVertex)}};
    for (const double value : method.*error) row.cells.push_back(numberCell("%.4f", value));
    rows.push_back(std::move(row));
  }
  return "<h3>" + title + "</h3>\n" + sortableTable(id, heads, rows);
}

}  // namespace

std::string visibilityPage(const std::vector<SceneComparison>& scenes, const VisibilitySettings& settings, const std::string& version) {
  std::string body =
      "<p>Ways to store what each vertex sees, against traced rays, on counted bytes: mean |error| of the visible fraction of normalised lobes, by sharpness; 16 random axes above the horizon of "
      "each point.</p>\n";
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto& [name, ground, seconds, comparison, figures] = scenes[i];
    body += "<h2>" + htmlText(name) + (ground ? " over a ground" : "") + "</h2>\n<p class=\"soft\">" + std::to_string(comparison.vertices) + " vertices, " + std::to_string(comparison.triangles) +
            " triangles.</p>\n";
    const std::string id = "scene" + std::to_string(i);
    if (comparison.pointsAtVertices > 0) body += tableOf(id + "_vertices", "At " + std::to_string(comparison.pointsAtVertices) + " vertices", comparison, &MethodError::atVertices);
    if (comparison.pointsInTriangles > 0) body += tableOf(id + "_triangles", "At " + std::to_string(comparison.pointsInTriangles) + " points inside triangles", comparison, &MethodError::inTriangles);
    if (!figures.empty()) body += "<div class=\"row figures\">\n" + figuresHtml(figures) + "</div>\n";
  }
  body += "<p class=\"soft\">" + std::to_string(settings.rays) + " rays a lobe. chiaro-report " + htmlText(version) + ".</p>\n";
  return pageHtml({.title = "Ways to store visibility", .body = body, .data = ""});
}

}  // namespace chiaro
