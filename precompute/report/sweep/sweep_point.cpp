#include "precompute/report/sweep/sweep_point.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/environment/sg_environment.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kNames[] = {"joint", "clustered", "pca", "paper", "SH", "Haar"};

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
double number(const Json& json) { return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>(); }

Json numbers(const ErrorBySharpness& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number(value));
  return json;
}

ErrorBySharpness numbers(const Json& json) {
  ErrorBySharpness values{};
  for (std::size_t s = 0; s < values.size(); ++s) values[s] = number(json.at(s));
  return values;
}

}  // namespace

double SweepFigures::worst(const ErrorBySharpness& error) {
  double most = 0.0;
  for (const double value : error)
    if (!(value <= most)) {
      if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
      most = value;
    }
  return most;
}

const char* nameOf(SweepForm form) { return kNames[static_cast<std::size_t>(form)]; }

std::string labelOf(const SweepPoint& point) {
  const auto count = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return std::string(text);
  };
  if (point.form == SweepForm::sphericalHarmonics || point.form == SweepForm::haar) return std::string(nameOf(point.form)) + " " + count(point.terms);
  if (point.form == SweepForm::paper) return "SSDF PCA " + count(point.terms) + " (Wang et al. 2009)";
  std::string text = std::string(nameOf(point.form)) + ", " + count(point.resolution) + " x " + count(point.resolution);
  if (point.samplingResolution != 0) text += " of " + count(point.samplingResolution);
  if (point.terms != 0) text += ", " + count(point.terms) + " terms";
  std::string drawn;
  if (point.lobes != 0) drawn += ", drawn with " + count(point.lobes) + (point.lobes == 1 ? " lobe" : " lobes");
  if (point.prefilter != 0 && point.prefilter != SgEnvironmentSettings{}.finestResolution) drawn += ", light of " + count(point.prefilter) + " texels";
  if (point.form == SweepForm::pca) return text + drawn;
  text += point.bytes > 0.0 ? ", " + count(point.bytes) + " bytes" : point.bytes < 0.0 ? ", no limit" : ", bytes by default";
  if (point.weightBits != 8) text += ", weights of " + count(point.weightBits) + " bits";
  if (point.functionBits != 0) text += ", functions of " + count(point.functionBits) + " bits";
  if (point.clusters != 0) text += ", " + count(point.clusters) + " clusters";
  return text + drawn;
}

std::string resultLine(const std::string& key, const SweepResult& result) {
  const auto& [point, figures] = result;
  return Json{{"key", key},
              {"form", nameOf(point.form)},
              {"resolution", point.resolution},
              {"sample_resolution", point.samplingResolution},
              {"terms", point.terms},
              {"bytes", point.bytes},
              {"weight_bits", point.weightBits},
              {"function_bits", point.functionBits},
              {"clusters", point.clusters},
              {"lobes", point.lobes},
              {"prefilter", point.prefilter},
              {"bytes_per_vertex", number(figures.bytesPerVertex)},
              {"seconds", number(figures.seconds)},
              {"cpu_seconds", number(figures.cpuSeconds)},
              {"mean_abs_at_vertices", numbers(figures.atVertices)},
              {"mean_abs_in_triangles", numbers(figures.inTriangles)},
              {"frame_ms", number(figures.frameMilliseconds)},
              {"picture_rmse", number(figures.pictureRmse)}}
      .dump();
}

std::optional<SweepResult> parseResultLine(const std::string& line, const std::string& key) {
  try {
    const Json json = Json::parse(line);
    if (json.at("key") != key) return {};
    SweepResult result;
    auto& [point, figures] = result;
    const auto form = json.at("form").get<std::string>();
    const auto* found = std::find(std::begin(kNames), std::end(kNames), form);
    if (found == std::end(kNames)) return {};
    point.form = static_cast<SweepForm>(found - std::begin(kNames));
    point.resolution = json.at("resolution");
    point.samplingResolution = json.at("sample_resolution");
    point.terms = json.at("terms");
    point.bytes = json.at("bytes");
    point.weightBits = json.at("weight_bits");
    point.functionBits = json.at("function_bits");
    point.clusters = json.at("clusters");
    point.lobes = json.at("lobes");
    point.prefilter = json.at("prefilter");
    figures.bytesPerVertex = number(json.at("bytes_per_vertex"));
    figures.seconds = number(json.at("seconds"));
    figures.cpuSeconds = number(json.at("cpu_seconds"));
    figures.atVertices = numbers(json.at("mean_abs_at_vertices"));
    figures.inTriangles = numbers(json.at("mean_abs_in_triangles"));
    figures.frameMilliseconds = number(json.at("frame_ms"));
    figures.pictureRmse = number(json.at("picture_rmse"));
    return result;
  } catch (const Json::exception&) {
    return {};
  }
}

}  // namespace chiaro
