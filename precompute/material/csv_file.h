#pragma once
/// Tables of text: one row a line, fields between commas, quoted where they hold commas (RFC 4180, without line breaks in fields).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace chiaro {

struct CsvRow {
  std::size_t line = 0;  ///< in the file, from 1
  std::vector<std::string> fields;
};

/// Every line that is not empty. `where` names the file. Throws Error (unreadableInput): no row, a quote that is not closed, or a zero byte,
/// which no text has.
std::vector<CsvRow> readCsv(std::span<const std::uint8_t> text, const std::string& where);

/// The number that is all of `field`, blanks around it aside. Throws Error (unreadableInput), with `where` and `line`, unless it is finite.
double csvNumber(const std::string& field, const std::string& where, std::size_t line);

}  // namespace chiaro
