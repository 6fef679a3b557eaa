#include "precompute/report/page/page.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "precompute/figure/html_text.h"
#include "precompute/report/page/page_texts.h"

namespace chiaro {
namespace {

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// In a script element nothing may look like the end of it.
std::string inScript(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace

std::string pageHtml(const Page& page) {
  const std::string title = htmlText(page.title);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\"><title>" +
      title + "</title><style>" + std::string(pageStyle()) + "</style></head><body>\n<h1>" + title + "</h1>\n" + page.body;
  if (!page.data.empty()) html += "<script type=\"application/json\" id=\"data\">" + inScript(page.data) + "</script>\n";
  html += "<script>" + std::string(pageScript()) + "</script>\n";
  for (const auto script : page.scripts) html += "<script>" + std::string(script) + "</script>\n";
  return html + "</body></html>\n";
}

Cell textCell(const std::string& text) { return {.html = htmlText(text), .value = std::numeric_limits<double>::quiet_NaN()}; }

Cell numberCell(const char* format, double value, bool bad) {
  return {.html = std::isfinite(value) ? formatted(format, value) : "-", .value = value, .bad = bad};
}

std::string sortableTable(const std::string& id, const std::vector<std::string>& heads, const std::vector<TableRow>& rows) {
  std::string html = "<div class=\"wide\"><table class=\"sortable\" id=\"" + id + "\"><thead><tr>";
  for (const auto& head : heads) html += "<th scope=\"col\"><button type=\"button\">" + htmlText(head) + "</button></th>";
  html += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    html += row.look.empty() ? "<tr>" : "<tr class=\"" + row.look + "\">";
    for (const auto& cell : row.cells) {
      html += cell.bad ? "<td class=\"bad\"" : "<td";
      if (std::isfinite(cell.value)) html += " data-value=\"" + formatted("%.9g", cell.value) + "\"";
      html += ">" + cell.html + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace chiaro
