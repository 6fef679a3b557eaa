#include "precompute/report/sweep/sweep_pictures.h"

#include <algorithm>

#include "precompute/reference/reference.h"

namespace chiaro {

SweepPictures::SweepPictures(const Scene& scene, const SweepPictureSettings& settings)
    : scene_(scene), settings_(settings), environment_(loadEnvironment(settings.environment)), camera_(resolveCamera(settings.camera, scene, static_cast<float>(settings.size.x) / static_cast<float>(settings.size.y))) {
  display_.exposure = autoExposure(environment_);
}

std::string SweepPictures::key() const {
  const auto& m = camera_.worldFromCamera;
  std::string text = settings_.environment + " " + std::to_string(settings_.size.x) + "x" + std::to_string(settings_.size.y) + ", " + std::to_string(settings_.samples) + " samples, " +
                     std::to_string(settings_.frames) + " frames, " + context_.renderer() + ", " + context_.version() + ", camera";
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) text += " " + std::to_string(m[c][r]);
  return text;
}

void SweepPictures::open(const BakedScene& baked) {
  renderer_.reset();  // first, so that the memory of two is never needed
  renderer_.emplace(baked);
}

const ReferenceHalves& SweepPictures::reference(const ProgressHandler& progress) {
  if (reference_) return *reference_;
  ReferenceSettings settings{.width = settings_.size.x, .height = settings_.size.y, .samplesPerPixel = std::max(2, settings_.samples / 2), .background = false, .threads = settings_.threads};
  ReferenceHalves halves;
  for (auto* half : {&halves.first, &halves.second}) {
    *half = renderReference(scene_, environment_, camera_, settings, progress).radiance;
    ++settings.seed;
  }
  return reference_.emplace(std::move(halves));
}

const SgEnvironment& SweepPictures::prefiltered(int resolution) {
  const auto known = prefiltered_.find(resolution);
  if (known != prefiltered_.end()) return known->second;
  SgEnvironmentSettings settings;
  settings.finestResolution = resolution;
  settings.threads = settings_.threads;
  return prefiltered_.emplace(resolution, prepareEnvironment(environment_, settings)).first->second;
}

void SweepPictures::measure(const SweepPoint& point, SweepFigures& figures, const ProgressHandler& progress) {
  renderer_->setEnvironment(prefiltered(point.prefilter));
  RenderSettings settings;
  settings.width = settings_.size.x;
  settings.height = settings_.size.y;
  settings.lobes = point.lobes;
  settings.background = false;
  settings.exposure = display_.exposure;
  std::vector<double> milliseconds;
  for (int frame = -1; frame < settings_.frames; ++frame) {
    renderer_->render(camera_, settings);
    const auto timings = renderer_->timings();
    if (frame >= 0) milliseconds.push_back(timings.passes.back().second);
  }
  std::nth_element(milliseconds.begin(), milliseconds.begin() + static_cast<std::ptrdiff_t>(milliseconds.size() / 2), milliseconds.end());
  figures.frameMilliseconds = milliseconds[milliseconds.size() / 2];
  const auto picture = renderer_->readRadiance();
  context_.debugLog().requireClean("the rendering");
  figures.pictureRmse = comparePictures(picture, reference(progress), display_).rmseWithoutNoise;
}

}  // namespace chiaro
