#include "precompute/material/ndf_table.h"

#include <algorithm>

#include "assets/error.h"
#include "precompute/material/csv_file.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

bool isName(const std::string& field) { return field.find_first_of("0123456789") == std::string::npos; }

}  // namespace

double NdfTable::at(double radians) const {
  if (radians <= angle.front()) return value.front();
  if (radians > angle.back()) return 0.0;
  const auto above = static_cast<std::size_t>(std::lower_bound(angle.begin(), angle.end(), radians) - angle.begin());
  const double share = (radians - angle[above - 1]) / (angle[above] - angle[above - 1]);
  return value[above - 1] + share * (value[above] - value[above - 1]);
}

double NdfTable::peak() const { return *std::max_element(value.begin(), value.end()); }

NdfTable readNdfTable(std::span<const std::uint8_t> csv, const std::string& where) {
  NdfTable table;
  const auto rows = readCsv(csv, where);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto& [line, fields] = rows[r];
    const std::string place = where + ":" + std::to_string(line);
    if (fields.size() != 2)
      throw inputError(place, "has " + std::to_string(fields.size()) + " fields", "write an angle in degrees and a value");
    if (r == 0 && isName(fields[0]) && isName(fields[1])) continue;
    const double degrees = csvNumber(fields[0], where, line), value = csvNumber(fields[1], where, line);
    const double radians = degrees / 180.0 * lobe64::kPi;
    if (!(degrees >= 0.0 && degrees <= 90.0))
      throw inputError(place, "the angle " + fields[0] + " is not between 0 and 90 degrees", "measure from the normal");
    if (!table.angle.empty() && !(radians > table.angle.back()))
      throw inputError(place, "the angle " + fields[0] + " is not above the one before", "sort the rows");
    if (value < 0.0) throw inputError(place, "the distribution is negative", "give values from 0 on");
    table.angle.push_back(radians);
    table.value.push_back(value);
  }
  if (table.angle.size() < 3)
    throw inputError(where, "has " + std::to_string(table.angle.size()) + " rows of numbers", "give at least three");
  if (!(table.peak() > 0.0)) throw inputError(where, "the distribution is 0 everywhere", "give one that is not");
  return table;
}

}  // namespace chiaro
