#include "precompute/report/visibility/visibility_tables.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "precompute/report/page/figures.h"
#include "precompute/report/visibility/lobe_truth.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json bySharpness(const ErrorBySharpness& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number(value));
  return json;
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string padded(std::string text, std::size_t width, bool left = false) {
  const std::string space(text.size() < width ? width - text.size() : 0, ' ');
  return left ? text + space : space + text;
}

std::string row(const std::string& name, const std::string& bytes, const ErrorBySharpness& values) {
  std::string line = padded(name, 28, true) + padded(bytes, 12);
  for (const double value : values) line += padded(formatted("%.4f", value), 9);
  return line + "\n";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::string visibilityTable(const SceneComparison& scene) {
  const auto& c = scene.comparison;
  std::string text = scene.scene + (scene.ground ? " over a ground" : "") + ": " + std::to_string(c.vertices) + " vertices, " +
                     std::to_string(c.triangles) + " triangles\n";
  const auto table = [&](const std::string& title, std::size_t points, ErrorBySharpness MethodError::*error) {
    if (points == 0) return;
    text += "\nmean |error| of the visible fraction of a lobe, " + std::to_string(points) + " points " + title + "\n";
    text += padded("by sharpness", 28, true) + padded("bytes/vertex", 12);
    for (const double sharpness : kLobeSharpness) text += padded(formatted("%g", sharpness), 9);
    text += "\n";
    for (const auto& method : c.methods) text += row(method.name, formatted("%.1f", method.bytesPerVertex), method.*error);
  };
  table("at vertices", c.pointsAtVertices, &MethodError::atVertices);
  table("inside triangles", c.pointsInTriangles, &MethodError::inTriangles);
  text += "\n" + row("mean of the truth", "", c.truthMean) + row("noise of the truth", "", c.truthNoise);
  return text;
}

std::string visibilityJson(const std::vector<SceneComparison>& scenes, const VisibilitySettings& settings,
                           const std::string& version) {
  Json json;
  json["program"] = "chiaro-report visibility";
  json["version"] = version;
  json["settings"] = {{"vertices", settings.vertices},
                      {"points", settings.points},
                      {"rays", settings.rays},
                      {"axes", LobeTruth::kAxes},
                      {"resolution", settings.resolution},
                      {"terms", settings.terms},
                      {"basis_vertices", settings.basisVertices},
                      {"seed", settings.seed}};
  json["sharpness"] = kLobeSharpness;
  json["scenes"] = Json::array();
  for (const auto& scene : scenes) {
    const auto& c = scene.comparison;
    Json one;
    one["scene"] = scene.scene;
    one["ground"] = scene.ground;
    one["vertices"] = c.vertices;
    one["triangles"] = c.triangles;
    one["points_at_vertices"] = c.pointsAtVertices;
    one["points_in_triangles"] = c.pointsInTriangles;
    one["basis_vertices"] = c.basisVertices;
    one["seconds"] = number(scene.seconds);
    one["truth_mean"] = bySharpness(c.truthMean);
    one["truth_noise"] = bySharpness(c.truthNoise);
    one["methods"] = Json::array();
    for (const auto& method : c.methods)
      one["methods"].push_back({{"name", method.name},
                                {"bytes_per_vertex", number(method.bytesPerVertex)},
                                {"bytes_each_vertex", number(method.bytes.eachVertex)},
                                {"bytes_shared", number(method.bytes.shared)},
                                {"mean_abs_at_vertices", bySharpness(method.atVertices)},
                                {"mean_abs_in_triangles", bySharpness(method.inTriangles)}});
    one["figures"] = figuresJson(scene.figures);
    json["scenes"].push_back(std::move(one));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string visibilityCsv(const std::vector<SceneComparison>& scenes) {
  std::ostringstream csv;
  csv.precision(9);
  csv << "scene,ground,vertices,place,method,bytes_per_vertex";
  for (const double sharpness : kLobeSharpness) csv << ",mean_abs_" << sharpness;
  csv << '\n';
  for (const auto& scene : scenes)
    for (const auto& [place, points, error] :
         {std::tuple{"vertices", scene.comparison.pointsAtVertices, &MethodError::atVertices},
          std::tuple{"triangles", scene.comparison.pointsInTriangles, &MethodError::inTriangles}}) {
      if (points == 0) continue;
      for (const auto& method : scene.comparison.methods) {
        csv << quoted(scene.scene) << ',' << (scene.ground ? 1 : 0) << ',' << scene.comparison.vertices << ',' << place << ','
            << quoted(method.name) << ',' << method.bytesPerVertex;
        for (const double value : method.*error) {
          csv << ',';
          if (std::isfinite(value)) csv << value;
        }
        csv << '\n';
      }
    }
  return csv.str();
}

std::string visibilityFiguresCsv(const std::vector<SceneComparison>& scenes) {
  std::string csv;
  for (const auto& scene : scenes) {
    if (scene.figures.empty()) continue;
    std::istringstream lines(figuresCsv(scene.figures));
    std::string line;
    std::getline(lines, line);
    if (csv.empty()) csv = "scene,ground," + line + "\n";
    while (std::getline(lines, line)) csv += quoted(scene.scene) + "," + (scene.ground ? "1" : "0") + "," + line + "\n";
  }
  return csv;
}

}  // namespace chiaro
