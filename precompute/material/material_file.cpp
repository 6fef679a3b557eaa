#include "precompute/material/material_file.h"

#include <algorithm>
#include <memory>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/material/abc_model.h"
#include "precompute/material/csv_file.h"
#include "precompute/material/sgd_model.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

/// A table whose columns have names.
class NamedTable {
 public:
  NamedTable(std::vector<CsvRow> rows, std::string where) : rows_(std::move(rows)), where_(std::move(where)) {
    for (const auto& row : rows_)
      if (row.fields.size() != rows_[0].fields.size())
        throw inputError(
            place(row),
            "has " + std::to_string(row.fields.size()) + " fields, the line of names " + std::to_string(rows_[0].fields.size()),
            "complete it");
    if (rows_.size() < 2) throw inputError(where_, "has no rows under its line of names", "name a whole table");
  }
  std::size_t size() const { return rows_.size() - 1; }
  bool has(const std::string& column) const { return std::find(names().begin(), names().end(), column) != names().end(); }
  const std::string& text(std::size_t row, const std::string& column) const {
    const auto at = std::find(names().begin(), names().end(), column);
    if (at == names().end()) throw inputError(where_, "has no column \"" + column + "\"", "name a whole table");
    return rows_[row + 1].fields[static_cast<std::size_t>(at - names().begin())];
  }
  double number(std::size_t row, const std::string& column) const { return csvNumber(text(row, column), where_, line(row)); }
  double positive(std::size_t row, const std::string& column) const {
    const double value = number(row, column);
    if (!(value > 0.0)) throw inputError(place(rows_[row + 1]), column + " is not above 0", "correct it");
    return value;
  }
  Vec3 colour(std::size_t row, const std::string& column) const {
    Vec3 value(0.0);
    for (int c = 0; c < 3; ++c) value[c] = number(row, column + "_" + "rgb"[c]);
    return value;
  }
  std::size_t line(std::size_t row) const { return rows_[row + 1].line; }

 private:
  const std::vector<std::string>& names() const { return rows_[0].fields; }
  std::string place(const CsvRow& row) const { return where_ + ":" + std::to_string(row.line); }
  std::vector<CsvRow> rows_;
  std::string where_;
};

MaterialData sgdRow(const NamedTable& table, std::size_t row) {
  std::array<SgdChannel, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string end = std::string("_") + "rgb"[c];
    const auto number = [&](const char* column) { return table.number(row, column + end); };
    channels[c] = {.rhoD = number("rhoD"),
                   .rhoS = number("rhoS"),
                   .alpha = table.positive(row, "alpha" + end),
                   .p = number("p"),
                   .f0 = number("f0"),
                   .f1 = number("f1"),
                   .kap = number("kap"),
                   .lambda = number("lambda"),
                   .c = number("c"),
                   .k = number("k"),
                   .theta0 = number("theta0")};
  }
  return {.name = table.text(row, "material"),
          .form = MaterialForm::sgd,
          .reflectance = sgdReflectance(channels),
          .ndf = {},
          .ngan = {}};
}

MaterialData abcRow(const NamedTable& table, std::size_t row) {
  const AbcModel model{.diffuse = table.colour(row, "kD"),
                       .a = table.colour(row, "A"),
                       .b = table.positive(row, "B"),
                       .c = table.number(row, "C"),
                       .ior = table.positive(row, "ior")};
  return {.name = table.text(row, "material"),
          .form = MaterialForm::abc,
          .reflectance = abcReflectance(model),
          .ndf = {},
          .ngan = {}};
}

MaterialData nganRow(const NamedTable& table, std::size_t row, const std::string& where) {
  NganModel model = parseNganModel(table.text(row, "lobes"), where, table.line(row));
  return {.name = table.text(row, "material") + "/" + table.text(row, "fit"),
          .form = MaterialForm::ngan,
          .reflectance = nganReflectance(model),
          .ndf = {},
          .ngan = model};
}

/// Without folders and endings.
std::string plainName(std::filesystem::path path) {
  path = path.filename();
  if (path.extension() == ".xz") path = path.stem();
  return path.stem().string();
}

}  // namespace

const char* formName(MaterialForm form) {
  constexpr const char* kNames[] = {"MERL", "SGD", "ABC", "Ngan", "NDF"};
  return kNames[static_cast<std::size_t>(form)];
}

std::vector<MaterialData> readMaterials(const std::filesystem::path& path) {
  const std::string where = path.string();
  if (path.extension() == ".binary" || path.extension() == ".xz") {
    const auto table = std::make_shared<const MerlTable>(readMerlFile(path));
    const auto lookup = [table](const Vec3& wo, const Vec3& wi) { return table->at(halfDifference(wo, wi)); };
    return {{.name = plainName(path), .form = MaterialForm::merl, .reflectance = lookup, .ndf = {}, .ngan = {}}};
  }
  if (path.extension() != ".csv")
    throw inputError(where, "is of no form that is known by its name", "name a .binary, .binary.xz or .csv file");
  const auto bytes = readFile(path);
  auto rows = readCsv(bytes, where);
  const auto& names = rows[0].fields;
  if (std::find(names.begin(), names.end(), "material") == names.end())
    return {
        {.name = plainName(path), .form = MaterialForm::ndf, .reflectance = {}, .ndf = readNdfTable(bytes, where), .ngan = {}}};
  const NamedTable table(std::move(rows), where);
  const bool sgd = table.has("rhoD_r"), abc = table.has("kD_r"), ngan = table.has("lobes");
  if (!sgd && !abc && !ngan)
    throw inputError(where, "its columns are of no table that is known",
                     "name one with columns rhoD_r (shifted gamma), kD_r (ABC) or lobes (Ngan)");
  std::vector<MaterialData> materials;
  for (std::size_t row = 0; row < table.size(); ++row)
    materials.push_back(sgd ? sgdRow(table, row) : abc ? abcRow(table, row) : nganRow(table, row, where));
  return materials;
}

MaterialData readMaterial(const std::filesystem::path& path, const std::string& row) {
  auto all = readMaterials(path);
  if (row.empty() && all.size() == 1) return all.front();
  if (row.empty())
    throw usageError("--row", path.string() + " has " + std::to_string(all.size()) + " materials",
                     "name one, such as --row " + all.front().name);
  const auto found = std::find_if(all.begin(), all.end(), [&](const MaterialData& one) { return one.name == row; });
  if (found == all.end())
    throw usageError("--row", path.string() + " has no \"" + row + "\"", "name one of its rows, such as " + all.front().name);
  return *found;
}

}  // namespace chiaro
