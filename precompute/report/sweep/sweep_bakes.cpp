#include "precompute/report/sweep/sweep_bakes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/transfer/transfer_format.h"
#include "precompute/elapsed.h"
#include "precompute/report/sweep/sweep.h"

namespace chiaro {

SweepPoint bakeOf(const SweepPoint& point) {
  SweepPoint bake = point;
  bake.lobes = 0;
  bake.prefilter = 0;
  return bake;
}

SweepBakes::SweepBakes(const Scene& scene, const VisibilitySettings& measure, std::filesystem::path folder, std::string key)
    : scene_(scene), measure_(measure), folder_(std::move(folder)), key_(std::move(key)) {}

std::filesystem::path SweepBakes::pathOf(const SweepPoint& point, const char* extension) const {
  return folder_ / (checksumOf(resultLine(key_, {.point = bakeOf(point), .figures = {}})) + extension);
}

SweepBake SweepBakes::bakeNow(const SweepPoint& point, const ProgressHandler& progress) const {
  BakeReport report;
  const double cpuBefore = cpuSeconds();
  SweepBake made{.baked = bake(scene_, bakeSettingsOf(point, measure_), report, progress)};
  made.cpuSeconds = cpuSeconds() - cpuBefore;
  made.seconds = report.seconds.total;
  if (made.baked.scene.vertexCount() != scene_.vertexCount()) throw std::logic_error("a prepared scene changed when it was baked");
  return made;
}

std::optional<SweepBake> SweepBakes::read(const SweepPoint& point) const {
  if (!isStored(point)) return {};
  try {
    const auto bytes = readFile(pathOf(point, ".json"));
    const auto json = nlohmann::json::parse(bytes.begin(), bytes.end());
    return SweepBake{.baked = readBakedScene(pathOf(point, ".glb")), .seconds = json.at("seconds"), .cpuSeconds = json.at("cpu_seconds")};
  } catch (const Error&) {
    return {};  // torn or of another version: made anew
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

const SweepBake& SweepBakes::get(const SweepPoint& point, const ProgressHandler& progress) {
  if (!last_ || !(last_->first == bakeOf(point))) {
    last_.reset();
    auto made = read(point);
    last_.emplace(bakeOf(point), made ? std::move(*made) : bakeNow(point, progress));
  }
  return last_->second;
}

bool SweepBakes::isStored(const SweepPoint& point) const {
  std::error_code ignored;
  return std::filesystem::exists(pathOf(point, ".json"), ignored) && std::filesystem::exists(pathOf(point, ".glb"), ignored);
}

void SweepBakes::store(const SweepPoint& point, const ProgressHandler& progress) const {
  const auto made = bakeNow(point, progress);
  writeBakedScene(pathOf(point, ".glb"), made.baked, "chiaro-report sweep");
  writeFileAtomically(pathOf(point, ".json"), nlohmann::json{{"seconds", made.seconds}, {"cpu_seconds", made.cpuSeconds}}.dump());
}

void SweepBakes::forget(const SweepPoint& point) const {
  std::error_code ignored;
  for (const char* extension : {".glb", ".json", ".log"}) std::filesystem::remove(pathOf(point, extension), ignored);
  std::filesystem::remove(folder_, ignored);  // fails where something is left in it
}

}  // namespace chiaro
