#include "precompute/report/report_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "precompute/report/error_map.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(std::optional<float> value) {
  return value ? Json(std::round(static_cast<double>(*value) * 1e6) / 1e6) : Json(nullptr);
}

std::string toneMapName(ToneMap toneMap) {
  switch (toneMap) {
    case ToneMap::neutral:
      return "neutral";
    case ToneMap::aces:
      return "aces";
    case ToneMap::clamp:
      return "clamp";
  }
  return "?";
}

std::string errorMapName(ErrorMapKind kind) {
  switch (kind) {
    case ErrorMapKind::difference:
      return "difference";
    case ErrorMapKind::flip:
      return "flip";
    case ErrorMapKind::hdrFlip:
      return "hdr-flip";
  }
  return "?";
}

Json caseJson(const Comparison& one) {
  const PictureDifference& d = one.difference;
  Json json;
  json["name"] = one.name;
  json["environment"] = one.environment;
  json["model"] = one.model ? Json(reflectanceNames()[static_cast<std::size_t>(*one.model)]) : Json();
  json["roughness"] = number(one.roughness);
  json["psnr_db"] = number(d.psnr);
  json["rmse"] = number(d.rmse);
  json["mean_absolute"] = number(d.meanAbsolute);
  json["bias"] = number(d.bias);
  json["worst"] = number(d.worst);
  json["object_pixels"] = d.objectPixels;
  json["undefined_pixels"] = d.undefinedPixels;
  json["coverage_mismatches"] = d.coverageMismatches;
  json["rmse_without_noise"] = number(d.rmseWithoutNoise);
  json["psnr_without_noise_db"] = number(psnrOf(d.rmseWithoutNoise));
  json["reference_noise_rms"] = number(d.noise);
  json["ssim"] = number(one.perceptual.ssim);
  json["flip"] = number(one.perceptual.flip);
  json["hdr_flip"] = number(one.perceptual.hdrFlip);
  json["hdr_flip_exposures"] = {
      {"start", one.perceptual.range.start}, {"stop", one.perceptual.range.stop}, {"count", one.perceptual.range.count}};
  json["exposure"] = number(static_cast<double>(one.display.exposure));
  json["environment_lights"] = one.lightCount;
  json["rays_traced"] = one.rays;
  json["seconds"] = {
      {"prepare_environment", one.prepareSeconds}, {"runtime", one.runtimeSeconds}, {"reference", one.referenceSeconds}};
  json["pictures"] = {
      {"runtime", one.name + "_runtime.png"}, {"reference", one.name + "_reference.png"}, {"error", one.name + "_error.png"}};
  json["worst_pixels"] = Json::array();
  for (const auto& pixel : one.worstPixels)
    json["worst_pixels"].push_back({{"x", pixel.x}, {"y", pixel.y}, {"rmse", pixel.difference}, {"bias", pixel.bias}});
  return json;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

ReportFacts factsOf(const BakedScene& baked, const ReportOptions& options) {
  ReportFacts facts;
  facts.toneMap = toneMapName(options.toneMap);
  facts.vertices = baked.scene.vertexCount();
  facts.triangles = baked.scene.triangleCount();
  facts.resolution = baked.transfer.resolution;
  facts.terms = baked.transfer.terms;
  facts.directions = baked.transfer.directionCount;
  facts.bytesPerVertex = baked.transfer.bytesPerVertex(facts.vertices, baked.coded ? &*baked.coded : nullptr);
  return facts;
}

double lowestPsnr(const Comparisons& comparisons) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Comparison& one : comparisons.cases) {
    if (std::isnan(one.difference.psnr)) return one.difference.psnr;
    lowest = std::min(lowest, one.difference.psnr);
  }
  return lowest;
}

double highestError(const Comparisons& comparisons, const ReportOptions& options) {
  double highest = 0.0;
  for (const Comparison& one : comparisons.cases) {
    const double error = judgedError(one, options);
    if (std::isnan(error)) return error;
    highest = std::max(highest, error);
  }
  return highest;
}

std::string reportJson(const ReportFacts& facts, const ReportOptions& options, const Comparisons& comparisons) {
  Json json;
  json["program"] = "chiaro-report";
  json["version"] = facts.version;
  json["scene"] = options.scene.string();
  json["compared_with"] = options.other.empty() ? Json(nullptr) : Json(options.other.string());
  json["vertices"] = facts.vertices;
  json["triangles"] = facts.triangles;
  json["resolution"] = facts.resolution;
  json["terms"] = facts.terms;
  json["directions"] = facts.directions;
  json["bytes_per_vertex"] = number(facts.bytesPerVertex);
  json["size"] = {options.size.x, options.size.y};
  json["supersample"] = options.supersample;
  json["samples"] = options.samples;
  json["shadows"] = options.shadows;
  json["metallic"] = number(options.metallic);
  json["lights"] = options.lights.size();
  json["tone_map"] = facts.toneMap;
  json["camera"] = {{"name", comparisons.camera.name},
                    {"eye",
                     {comparisons.camera.worldFromCamera[3].x, comparisons.camera.worldFromCamera[3].y,
                      comparisons.camera.worldFromCamera[3].z}}};
  json["gl"] = {{"renderer", comparisons.glRenderer}, {"version", comparisons.glVersion}};
  json["error_map_range"] = kErrorMapRange;
  json["error_map"] = errorMapName(options.errorMap);
  json["lowest_psnr_db"] = number(lowestPsnr(comparisons));
  json["fail_under_db"] = options.failUnder ? Json(*options.failUnder) : Json(nullptr);
  json["highest_rmse"] = number(highestError(comparisons, options));
  json["fail_over"] = options.failOver ? Json(*options.failOver) : Json(nullptr);
  json["cases"] = Json::array();
  for (const Comparison& one : comparisons.cases) json["cases"].push_back(caseJson(one));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string reportCsv(const Comparisons& comparisons) {
  std::ostringstream csv;
  csv << "name,environment,model,roughness,psnr_db,rmse,mean_absolute,bias,worst,object_pixels,undefined_pixels,coverage_mismatches,"
         "rmse_without_noise,psnr_without_noise_db,reference_noise_rms,exposure,environment_lights,rays_traced,prepare_seconds,"
         "runtime_seconds,reference_seconds,ssim,flip,hdr_flip\n";
  csv.precision(9);
  const auto figure = [&](double value) {
    csv << ',';
    if (std::isfinite(value)) csv << value;
  };
  for (const Comparison& one : comparisons.cases) {
    const PictureDifference& d = one.difference;
    csv << one.name << ',' << quoted(one.environment) << ',' << (one.model ? reflectanceNames()[static_cast<std::size_t>(*one.model)] : "") << ',';
    if (one.roughness) csv << *one.roughness;
    for (const double value : {d.psnr, d.rmse, d.meanAbsolute, d.bias, d.worst}) figure(value);
    csv << ',' << d.objectPixels << ',' << d.undefinedPixels << ',' << d.coverageMismatches;
    for (const double value :
         {d.rmseWithoutNoise, psnrOf(d.rmseWithoutNoise), d.noise, static_cast<double>(one.display.exposure)})
      figure(value);
    csv << ',' << one.lightCount << ',' << one.rays;
    for (const double value : {one.prepareSeconds, one.runtimeSeconds, one.referenceSeconds, one.perceptual.ssim,
                               one.perceptual.flip, one.perceptual.hdrFlip})
      figure(value);
    csv << '\n';
  }
  return csv.str();
}

}  // namespace chiaro
