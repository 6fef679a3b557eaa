#include "precompute/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "assets/error.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/parallel.h"
#include "precompute/reference/direct_light.h"
#include "precompute/reference/environment_sampler.h"
#include "precompute/reference/sampling.h"
#include "precompute/reference/surface.h"
#include "precompute/reference/view_ray.h"

namespace chiaro {
namespace {

using namespace reference;

constexpr int kTile = 16;
/// Blended surfaces behind one another; what lies behind the last is not seen.
constexpr int kMaxLayers = 64;

/// What one ray of the camera brings back, in front of whatever the background is.
struct Seen {
  glm::dvec3 radiance{0.0};
  glm::dvec3 variance{0.0};
  double coverage = 0.0;
  std::uint64_t rays = 0;
};

class Renderer {
 public:
  Renderer(const Scene& scene, const Environment& environment, const Camera& camera, const ReferenceSettings& settings)
      : scene_(scene),
        camera_(camera),
        settings_(settings),
        rays_(scene),
        surfaces_(scene, settings.energyCompensation),
        environment_(environment, settings.worldFromEnvironment) {}

  void renderPixel(int x, int y, ReferenceImage& image, std::uint64_t& rays) const {
    const int grid = settings_.pixelGrid;
    const int samples = (settings_.samplesPerPixel + grid * grid - 1) / (grid * grid);
    const std::size_t index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(settings_.width) + static_cast<std::size_t>(x);
    const std::uint32_t pixelSeed =
        hashWords(hashWords(settings_.seed, static_cast<std::uint32_t>(x)), static_cast<std::uint32_t>(y));
    const double aspect = static_cast<double>(settings_.width) / settings_.height;
    Seen sum;
    for (int point = 0; point < grid * grid; ++point) {
      const glm::dvec2 within((point % grid + 0.5) / grid, (point / grid + 0.5) / grid);
      const glm::dvec2 at = (glm::dvec2(x, y) + within) / glm::dvec2(settings_.width, settings_.height);
      const Seen seen = look(viewRay(camera_, aspect, at), samples, hashWords(pixelSeed, static_cast<std::uint32_t>(point)));
      sum.radiance += seen.radiance;
      sum.variance += seen.variance;
      sum.coverage += seen.coverage;
      rays += seen.rays;
    }
    const double share = 1.0 / (grid * grid);
    image.radiance.texels[index] = glm::vec4(glm::dvec4(sum.radiance * share, sum.coverage * share));
    image.varianceOfMean.texels[index] = glm::vec3(sum.variance * (share * share));
  }

 private:
  /// Follows a ray through blended surfaces to the first opaque one.
  Seen look(const ViewRay& ray, int samples, std::uint32_t seed) const {
    Seen seen;
    double transmitted = 1.0;
    float near = ray.near;
    for (int layer = 0; layer < kMaxLayers && transmitted > 0.0; ++layer) {
      RayHit hit;
      ++seen.rays;
      if (!rays_.intersect(ray.origin, ray.direction, near, ray.far, hit)) break;
      const glm::vec3 position = ray.origin + hit.distance * ray.direction;
      near = std::max(hit.distance + rays_.surfaceOffset(position),
                      std::nextafter(hit.distance, std::numeric_limits<float>::infinity()));
      if (surfaces_.isCulled(hit, ray.direction)) continue;
      const glm::dvec3 wo = -glm::normalize(glm::dvec3(ray.direction));
      const Surface surface = surfaces_.at(hit, wo);
      const double weight = transmitted * surface.opacity;
      if (weight > 0.0) {
        const RayScene* occluders = settings_.shadows ? &rays_ : nullptr;
        const Estimate sky =
            environmentLight(surface, wo, environment_, occluders, samples, hashWords(seed, static_cast<std::uint32_t>(layer)));
        const Estimate lamps =
            lampLight(surface, wo, scene_.lights, occluders, samples, hashWords(seed, static_cast<std::uint32_t>(layer)));
        seen.radiance += weight * (sky.mean + lamps.mean + surface.emission);
        seen.variance += weight * weight * (sky.varianceOfMean + lamps.varianceOfMean);
        seen.rays += sky.rays + lamps.rays;
      }
      transmitted *= 1.0 - surface.opacity;
    }
    seen.coverage = 1.0 - transmitted;
    if (settings_.background && transmitted > 0.0)
      seen.radiance += transmitted * environment_.radiance(glm::normalize(glm::dvec3(ray.direction)));
    return seen;
  }

  const Scene& scene_;
  const Camera& camera_;
  const ReferenceSettings& settings_;
  RayScene rays_;
  SurfaceReader surfaces_;
  EnvironmentSampler environment_;
};

void check(const Environment& environment, const ReferenceSettings& settings) {
  const auto refuse = [](const char* option, const std::string& value, const char* remedy) {
    throw usageError(option, value + " is out of range", remedy);
  };
  if (settings.width < 1 || settings.height < 1)
    refuse("size", std::to_string(settings.width) + "x" + std::to_string(settings.height), "give at least 1x1");
  if (settings.samplesPerPixel < 2)
    refuse("samples", std::to_string(settings.samplesPerPixel), "give at least 2: one sample has no variance");
  if (settings.pixelGrid < 1 || settings.pixelGrid > 64) refuse("pixel grid", std::to_string(settings.pixelGrid), "give 1 to 64");
  if (environment.radiance.texels.empty())
    throw inputError(environment.name, "the environment has no texels", "give another environment");
}

/// Root mean square over pixels and channels, where anything is seen.
double noiseOf(const ReferenceImage& image) {
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < image.radiance.texels.size(); ++i) {
    const double coverage = static_cast<double>(image.radiance.texels[i].a);
    if (!(coverage > 0.0)) continue;
    const glm::dvec3 variance(image.varianceOfMean.texels[i]);
    sum += (variance.x + variance.y + variance.z) / 3.0;
    weight += 1.0;
  }
  return weight > 0.0 ? std::sqrt(sum / weight) : 0.0;
}

}  // namespace

ReferenceImage renderReference(const Scene& scene, const Environment& environment, const Camera& camera,
                               const ReferenceSettings& settings, const ProgressHandler& progress) {
  check(environment, settings);
  const Renderer renderer(scene, environment, camera, settings);
  ReferenceImage image;
  const std::size_t pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
  image.radiance = {settings.width, settings.height, std::vector<glm::vec4>(pixels)};
  image.varianceOfMean = {settings.width, settings.height, std::vector<glm::vec3>(pixels)};

  const int tilesAcross = (settings.width + kTile - 1) / kTile;
  const int tilesDown = (settings.height + kTile - 1) / kTile;
  const auto tileCount = static_cast<std::size_t>(tilesAcross) * static_cast<std::size_t>(tilesDown);
  std::mutex mutex;
  std::size_t tilesDone = 0;
  parallelBlocks(settings.threads, tileCount, [&](std::size_t tile) {
    const int left = static_cast<int>(tile % static_cast<std::size_t>(tilesAcross)) * kTile;
    const int top = static_cast<int>(tile / static_cast<std::size_t>(tilesAcross)) * kTile;
    std::uint64_t rays = 0;
    for (int y = top; y < std::min(top + kTile, settings.height); ++y) {
      for (int x = left; x < std::min(left + kTile, settings.width); ++x) renderer.renderPixel(x, y, image, rays);
    }
    const std::lock_guard lock(mutex);
    image.raysTraced += rays;
    ++tilesDone;
    if (progress) progress("reference", static_cast<double>(tilesDone) / static_cast<double>(tileCount));
  });
  image.noiseRms = noiseOf(image);
  return image;
}

}  // namespace chiaro
