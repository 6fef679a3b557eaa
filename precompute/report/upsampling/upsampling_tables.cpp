#include "precompute/report/upsampling/upsampling_tables.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace chiaro {

std::string upsamplingTable(const std::vector<MaterialResult>& results) {
  std::string text;
  char line[256];
  std::snprintf(line, sizeof line, "%-16s %-27s %8s %7s %7s %7s %8s %9s %9s %8s %10s %7s\n", "material", "variant", "rmse", "psnr", "whole", "lowest", "flip", "flicker",
                "change", "shaded", "of objects", "time");
  text += line;
  for (const auto& material : results) {
    for (const auto& one : material.variants) {
      std::snprintf(line, sizeof line, "%-16s %-27s %8.5f %7.2f %7.2f %7.2f %8.4f %+9.5f %9.5f %7.1f%% %9.1f%% %7.3f\n", material.material.name().c_str(), one.variant.name.c_str(),
                    one.rmse, one.psnr, one.wholePsnr, one.lowestPsnr, one.flip, one.flicker, one.changeError, 100.0 * one.recomputed, 100.0 * one.recomputedOfObjects,
                    one.milliseconds / material.fullMilliseconds);
      text += line;
    }
  }
  return text;
}

std::string upsamplingJson(const std::vector<MaterialResult>& results, const UpsamplingOptions& options, const std::string& glRenderer,
                           const std::string& version) {
  const auto& settings = options.settings;
  nlohmann::ordered_json json;
  json["program"] = "chiaro-report upsampling";
  json["version"] = version;
  json["scene"] = options.scene.string();
  json["gl_renderer"] = glRenderer;
  json["environment"] = settings.environment;
  json["camera"] = options.camera;
  json["size"] = {settings.size.x, settings.size.y};
  json["upsample"] = settings.upsample;
  json["frames"] = settings.frames;
  json["warm_up"] = settings.warmUp;
  json["flip_every"] = flipEvery(settings);
  json["turn_deg"] = settings.turnDegrees;
  json["moving"] = settings.moving;
  json["moving_deg"] = settings.movingDegrees;
  json["vertex_frames"] = settings.shapes.frames.string();
  json["recompute_share"] = settings.recompute;
  json["materials"] = nlohmann::ordered_json::array();
  for (const auto& material : results) {
    auto variants = nlohmann::ordered_json::array();
    for (const auto& one : material.variants) {
      variants.push_back({{"name", one.variant.name},
                          {"rmse", one.rmse},
                          {"psnr_db", one.psnr},
                          {"whole_psnr_db", one.wholePsnr},
                          {"lowest_psnr_db", one.lowestPsnr},
                          {"flip", one.flip},
                          {"flicker", one.flicker},
                          {"change_error", one.changeError},
                          {"recomputed_share", one.recomputed},
                          {"recomputed_share_of_objects", one.recomputedOfObjects},
                          {"gpu_ms", one.milliseconds},
                          {"filter_gpu_ms", one.filterMilliseconds}});
    }
    json["materials"].push_back({{"material", material.material.name()}, {"full_gpu_ms", material.fullMilliseconds}, {"variants", std::move(variants)}});
  }
  return json.dump(2) + "\n";
}

}  // namespace chiaro
