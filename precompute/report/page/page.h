#pragma once
/// One self-contained web page: its style, scripts and data are in it, and it asks no network for anything.

#include <string>
#include <string_view>
#include <vector>

namespace chiaro {

struct Page {
  std::string title;                       ///< plain text
  std::string body;                        ///< HTML
  std::string data;                        ///< JSON that the scripts read; empty: none
  std::vector<std::string_view> scripts{}; ///< after the page's own
};

/// Readable at phone width and in dark mode.
std::string pageHtml(const Page& page);

/// A cell of a table: what is shown (HTML) and what it is sorted by (a finite number, or else the text shown).
struct Cell {
  std::string html;
  double value;
  bool bad = false;
};
Cell textCell(const std::string& text);
/// Not finite: "-".
Cell numberCell(const char* format, double value, bool bad = false);

struct TableRow {
  std::vector<Cell> cells;
  std::string look{};  ///< CSS class
};

/// Scrolls sideways where it is too wide; a click or Enter on a head sorts by its column.
std::string sortableTable(const std::string& id, const std::vector<std::string>& heads, const std::vector<TableRow>& rows);

}  // namespace chiaro
