#include "precompute/report/sweep/sweep_tables.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "precompute/report/sweep/pareto.h"
#include "precompute/report/visibility/lobe_truth.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

struct Fronts {
  explicit Fronts(const SweepStudy& study)
      : bytes(frontOf(study.results, SweepPlace::vertices, kWorst, SweepCost::bytesPerVertex)),
        seconds(frontOf(study.results, SweepPlace::vertices, kWorst, SweepCost::cpuSeconds)),
        frames(frontOf(study.results, SweepPlace::vertices, kPicture, SweepCost::frameMilliseconds)) {}
  std::vector<bool> bytes, seconds, frames;
};

}  // namespace

double errorOf(const SweepResult& result, SweepPlace place, std::size_t measure) {
  const auto& error = place == SweepPlace::vertices ? result.figures.atVertices : result.figures.inTriangles;
  if (measure == kPicture) return result.figures.pictureRmse;
  return measure == kWorst ? SweepFigures::worst(error) : error[measure];
}

double costOf(const SweepResult& result, SweepCost cost) {
  switch (cost) {
    case SweepCost::bytesPerVertex: return result.figures.bytesPerVertex;
    case SweepCost::cpuSeconds: return result.figures.cpuSeconds;
    case SweepCost::frameMilliseconds: return result.figures.frameMilliseconds;
  }
  return SweepFigures::kNone;
}

std::vector<bool> frontOf(const std::vector<SweepResult>& results, SweepPlace place, std::size_t measure, SweepCost cost) {
  std::vector<double> costs, errors;
  for (const auto& result : results) {
    costs.push_back(costOf(result, cost));
    errors.push_back(errorOf(result, place, measure));
  }
  return paretoFront(costs, errors);
}

std::string sweepTable(const SweepStudy& study) {
  char line[200];
  std::snprintf(line, sizeof line, "%-58s%14s%14s%10s%10s%10s%10s  front\n", "setting", "bytes/vertex", "CPU seconds", "error", "inside", "frame ms", "picture");
  std::string text = study.scene + ": " + std::to_string(study.facts.vertices) + " vertices, " + std::to_string(study.facts.triangles) + " triangles; " +
                     std::to_string(study.results.size()) + " points, " + std::to_string(study.facts.resumed) + " of them known before\n\n" + line;
  const Fronts fronts(study);
  for (std::size_t i = 0; i < study.results.size(); ++i) {
    const auto& result = study.results[i];
    const auto cell = [&](const char* format, double value) {
      std::snprintf(line, sizeof line, format, value);
      return std::string(std::isfinite(value) ? line : "-");
    };
    std::snprintf(line, sizeof line, "%-58s%14s%14s%10s%10s%10s%10s  %s%s%s\n", labelOf(result.point).c_str(), cell("%.1f", result.figures.bytesPerVertex).c_str(),
                  cell("%.1f", result.figures.cpuSeconds).c_str(), cell("%.4f", errorOf(result, SweepPlace::vertices, kWorst)).c_str(),
                  cell("%.4f", errorOf(result, SweepPlace::triangles, kWorst)).c_str(), cell("%.2f", result.figures.frameMilliseconds).c_str(), cell("%.4f", result.figures.pictureRmse).c_str(),
                  fronts.bytes[i] ? "bytes " : "", fronts.seconds[i] ? "time " : "", fronts.frames[i] ? "frame" : "");
    text += line;
  }
  return text;
}

std::string sweepJson(const SweepStudy& study, const std::string& version) {
  const auto& measure = study.measure;
  Json json{{"program", "chiaro-report sweep"},
            {"version", version},
            {"scene", study.scene},
            {"ground", study.ground},
            {"vertices", study.facts.vertices},
            {"triangles", study.facts.triangles},
            {"settings",
             {{"vertices", measure.vertices},
              {"points", measure.points},
              {"rays", measure.rays},
              {"axes", LobeTruth::kAxes},
              {"basis_vertices", measure.basisVertices},
              {"seed", measure.seed}}},
            {"gl_renderer", study.glRenderer.empty() ? Json(nullptr) : Json(study.glRenderer)},
            {"frames",
             study.glRenderer.empty() ? Json(nullptr)
                                      : Json{{"environment", study.drawn.environment}, {"size", {study.drawn.size.x, study.drawn.size.y}}, {"samples", study.drawn.samples}, {"frames", study.drawn.frames}}},
            {"target_error", study.targetError ? Json(*study.targetError) : Json(nullptr)},
            {"target_frame_ms", study.targetFrameTime ? Json(*study.targetFrameTime) : Json(nullptr)},
            {"chosen", study.targets() && study.chosen ? Json(*study.chosen) : Json(nullptr)},
            {"sharpness", kLobeSharpness},
            {"points", Json::array()}};
  const Fronts fronts(study);
  for (std::size_t i = 0; i < study.results.size(); ++i) {
    const auto& result = study.results[i];
    Json point = Json::parse(resultLine("", result));
    point.erase("key");
    point["error"] = number(errorOf(result, SweepPlace::vertices, kWorst));
    point["error_in_triangles"] = number(errorOf(result, SweepPlace::triangles, kWorst));
    point["on_front_of_bytes"] = static_cast<bool>(fronts.bytes[i]);
    point["on_front_of_cpu_seconds"] = static_cast<bool>(fronts.seconds[i]);
    point["on_front_of_frame_ms"] = static_cast<bool>(fronts.frames[i]);
    json["points"].push_back(std::move(point));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string sweepCsv(const SweepStudy& study) {
  std::ostringstream csv;
  csv.precision(9);
  const auto add = [&](double value) {
    csv << ',';
    if (std::isfinite(value)) csv << value;
  };
  csv << "form,resolution,sample_resolution,terms,bytes,weight_bits,function_bits,clusters,lobes,prefilter,bytes_per_vertex,seconds,cpu_seconds,error,error_in_triangles,frame_ms,picture_rmse,on_front_of_bytes,"
         "on_front_of_cpu_seconds,on_front_of_frame_ms";
  for (const char* place : {"vertices", "triangles"})
    for (const double sharpness : kLobeSharpness) csv << ',' << place << '_' << sharpness;
  csv << '\n';
  const Fronts fronts(study);
  for (std::size_t i = 0; i < study.results.size(); ++i) {
    const auto& [point, figures] = study.results[i];
    csv << nameOf(point.form) << ',' << point.resolution << ',' << point.samplingResolution << ',' << point.terms << ',' << point.bytes << ',' << point.weightBits << ','
        << point.functionBits << ',' << point.clusters << ',' << point.lobes << ',' << point.prefilter;
    for (const double value : {figures.bytesPerVertex, figures.seconds, figures.cpuSeconds, errorOf(study.results[i], SweepPlace::vertices, kWorst),
                               errorOf(study.results[i], SweepPlace::triangles, kWorst), figures.frameMilliseconds, figures.pictureRmse})
      add(value);
    csv << ',' << (fronts.bytes[i] ? 1 : 0) << ',' << (fronts.seconds[i] ? 1 : 0) << ',' << (fronts.frames[i] ? 1 : 0);
    for (const auto* errors : {&figures.atVertices, &figures.inTriangles})
      for (const double value : *errors) add(value);
    csv << '\n';
  }
  return csv.str();
}

}  // namespace chiaro
