#include "precompute/report/brdf/measured_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "precompute/figure/html_text.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string formatted(double value) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string padded(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}
std::string padded(double value, std::size_t width) { return padded(formatted(value), width); }

double parameter(const MeasuredMaterial& m) { return modelFamily(m.best.kind).published(m.best.fit.width); }

struct Column {
  const char* title;
  const char* key;
  double (*value)(const MeasuredMaterial&);
};
constexpr Column kColumns[] = {
    {"parameter", "parameter", parameter},
    {"F0", "f0_luminance", [](const MeasuredMaterial& m) { return luminance(m.best.fit.f0()); }},
    {"F90", "f90", [](const MeasuredMaterial& m) { return m.best.fit.f90; }},
    {"diffuse", "diffuse_luminance", [](const MeasuredMaterial& m) { return luminance(m.best.fit.diffuse); }},
    {"log error", "error", [](const MeasuredMaterial& m) { return m.best.fit.error; }},
    {"model", "equation_11_model", [](const MeasuredMaterial& m) { return m.best.error; }},
    {"3 lobes", "equation_11_mixture", [](const MeasuredMaterial& m) { return m.best.mixtureError; }},
    {"isotropic", "equation_11_isotropic_warp", [](const MeasuredMaterial& m) { return m.best.isotropicError; }},
    {"chosen", "equation_11_chosen_warp", [](const MeasuredMaterial& m) { return m.best.chosenError; }},
    {"ours", "equation_11_ours", [](const MeasuredMaterial& m) { return m.ours; }},
    {"by cos", "equation_11_model_by_cosine", [](const MeasuredMaterial& m) { return m.cosineModel; }},
    {"3 lobes", "equation_11_mixture_by_cosine", [](const MeasuredMaterial& m) { return m.cosineMixture; }},
    {"16", "factored_16", [](const MeasuredMaterial& m) { return m.factored16; }},
    {"64", "factored_64", [](const MeasuredMaterial& m) { return m.factored64; }},
    {"256", "factored_256", [](const MeasuredMaterial& m) { return m.factored256; }}};

struct RefitColumn {
  const char* title;
  const char* key;
  double NganRefit::*value;
};
constexpr RefitColumn kRefitColumns[] = {
    {"published", "published_parameter", &NganRefit::publishedWidth},    {"refit", "parameter", &NganRefit::width},
    {"peak, publ.", "published_peak", &NganRefit::publishedPeak},        {"peak, refit", "peak", &NganRefit::peak},
    {"diff., publ.", "published_diffuse", &NganRefit::publishedDiffuse}, {"diff., refit", "diffuse", &NganRefit::diffuse},
    {"error, publ.", "published_error", &NganRefit::publishedError},     {"error, refit", "error", &NganRefit::error}};

}  // namespace

std::string measuredTable(const MeasuredStudy& study) {
  std::string text =
      "\nmeasured materials, the best model of each; equation (11) of luminance against the data, directions to 80 degrees\n" +
      padded("source", 6) + padded("material", 40) + padded("model", 18);
  for (const Column& column : kColumns) text += padded(column.title, 10);
  text += "\n";
  for (const MeasuredMaterial& m : study.materials) {
    text += padded(formName(m.form), 6) + padded(m.name, 40) + padded(modelJsonName(m.best.kind), 18);
    for (const Column& column : kColumns) text += padded(column.value(m), 10);
    text += "\n";
  }
  if (study.refits.empty()) return text;
  text += "\nNgan's models fitted anew to reconstructions of the same materials, by their metric (red channel)\n" +
          padded("material", 22) + padded("family", 18) + padded("source", 8);
  for (const RefitColumn& column : kRefitColumns) text += padded(column.title, 14);
  text += "\n";
  for (const NganRefit& r : study.refits) {
    text += padded(r.material, 22) + padded(r.family, 18) + padded(r.source, 8);
    for (const RefitColumn& column : kRefitColumns) text += padded(r.*column.value, 14);
    text += "\n";
  }
  return text;
}

Json measuredJson(const MeasuredStudy& study) {
  Json json{{"materials", Json::array()}, {"ngan_refits", Json::array()}};
  for (const MeasuredMaterial& m : study.materials) {
    Json one{{"file", m.file}, {"source", formName(m.form)}, {"material", m.name}, {"model", modelJsonName(m.best.kind)}};
    for (const Column& column : kColumns) one[column.key] = number(column.value(m));
    if (std::isfinite(m.factored256)) one["factored_resolved"] = m.resolved;
    json["materials"].push_back(std::move(one));
  }
  for (const NganRefit& r : study.refits) {
    Json one{{"material", r.material}, {"family", r.family}, {"source", r.source}};
    for (const RefitColumn& column : kRefitColumns) one[column.key] = number(r.*column.value);
    json["ngan_refits"].push_back(std::move(one));
  }
  return json;
}

std::string measuredHtml(const MeasuredStudy& study) {
  std::string html =
      "<h2>Measured materials</h2>\n<p class=\"soft\">The best of six models, fitted to log(1 + &rho; cos); equation (11) of "
      "luminance against the data, both directions up to 80 degrees: of the model "
      "itself, of three lobes in place of its distribution, of those warped isotropically and by the chosen rule, of the nine "
      "lobes that a shader reads; of the best model fitted to &rho; cos and its three lobes; and of 16, 64 and 256 factored "
      "terms, which are larger still where the width is below .05: the grid is too coarse for it.</p>\n<div "
      "class=\"wide\"><table><tr><th>material</th><th>source</th><th>model</th>";
  for (const Column& column : kColumns) html += "<th>" + std::string(column.title) + "</th>";
  html += "</tr>\n";
  for (const MeasuredMaterial& m : study.materials) {
    html += "<tr><td>" + htmlText(m.name) + "</td><td>" + formName(m.form) + "</td><td>" + modelJsonName(m.best.kind) + "</td>";
    for (const Column& column : kColumns) html += "<td>" + formatted(column.value(m)) + "</td>";
    html += "</tr>\n";
  }
  html += "</table></div>\n";
  if (study.refits.empty()) return html;
  html +=
      "<h2>Ngan's parameters, published and fitted anew</h2>\n<p class=\"soft\">The same families by the same metric (root mean "
      "square of &rho; cos), but to reconstructions: the measurements are "
      "not here. Red channel, which both editions of the database share. Errors of both on the reconstruction.</p>\n<div "
      "class=\"wide\"><table><tr><th>material</th><th>family</th><th>source</th>";
  for (const RefitColumn& column : kRefitColumns) html += "<th>" + std::string(column.title) + "</th>";
  html += "</tr>\n";
  for (const NganRefit& r : study.refits) {
    html += "<tr><td>" + htmlText(r.material) + "</td><td>" + r.family + "</td><td>" + r.source + "</td>";
    for (const RefitColumn& column : kRefitColumns) html += "<td>" + formatted(r.*column.value) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace chiaro
