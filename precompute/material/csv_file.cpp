#include "precompute/material/csv_file.h"

#include <charconv>
#include <cmath>

#include "assets/error.h"

namespace chiaro {
namespace {

std::string placeOf(const std::string& where, std::size_t line) { return where + ":" + std::to_string(line); }

std::vector<std::string> fieldsOf(const std::string& line, const std::string& place) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += c, ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  if (quoted) throw inputError(place, "a quote is not closed", "close it in the same line");
  return fields;
}

}  // namespace

std::vector<CsvRow> readCsv(std::span<const std::uint8_t> text, const std::string& where) {
  std::vector<CsvRow> rows;
  std::string line;
  std::size_t number = 0;
  const auto finish = [&] {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") != std::string::npos) rows.push_back({number, fieldsOf(line, placeOf(where, number))});
    line.clear();
  };
  for (const auto byte : text) {
    if (byte == 0) throw inputError(where, "is no text: it has a zero byte", "name a .csv file");
    if (byte == '\n')
      finish();
    else
      line += static_cast<char>(byte);
  }
  finish();
  if (rows.empty()) throw inputError(where, "has no rows", "name a table with a line of column names and rows under it");
  return rows;
}

double csvNumber(const std::string& field, const std::string& where, std::size_t line) {
  const auto from = field.find_first_not_of(" \t"), to = field.find_last_not_of(" \t");
  double value = 0.0;
  bool whole = false;
  if (from != std::string::npos) {
    const char* first = field.data() + from;
    const char* last = field.data() + to + 1;
    if (*first == '+') ++first;
    const auto result = std::from_chars(first, last, value);
    whole = result.ec == std::errc() && result.ptr == last;
  }
  if (!whole || !std::isfinite(value))
    throw inputError(placeOf(where, line), "\"" + field + "\" is no finite number", "write one such as 0.25");
  return value;
}

}  // namespace chiaro
