#include "precompute/material/sphere_picture.h"

#include <algorithm>
#include <cmath>

#include "precompute/parallel.h"
#include "precompute/reference/brdf.h"
#include "precompute/reference/environment_sampler.h"
#include "precompute/reference/sampling.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

struct Frame {
  Vec3 x, y, z;
  Vec3 local(const Vec3& w) const { return Vec3(dot(w, x), dot(w, y), dot(w, z)); }
  Vec3 world(const Vec3& l) const { return l.x * x + l.y * y + l.z * z; }
};

Frame frameOf(const Vec3& n) {
  const Vec3 x = glm::normalize(glm::cross(std::abs(n.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), n));
  return {x, glm::cross(n, x), n};
}

}  // namespace

ImageRgba spherePicture(const std::vector<ReflectanceFunction>& reflectances, const Environment& environment,
                        const SphereOptions& options) {
  const reference::EnvironmentSampler light(environment, glm::mat3(1.0f));
  reference::Brdf sampler;
  sampler.alphaX = sampler.alphaY = std::clamp(options.width, reference::kMinAlpha, 1.0);
  const int size = options.size, count = static_cast<int>(reflectances.size());
  ImageRgba image{
      size * count, size,
      std::vector<glm::vec4>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size * count), glm::vec4(0.0f))};
  parallelBlocks(options.threads, static_cast<std::size_t>(size), [&](std::size_t row) {
    std::vector<Vec3> sums(reflectances.size());
    for (int column = 0; column < size; ++column) {
      const double x = (2.0 * column + 1.0) / size - 1.0, y = 1.0 - (2.0 * static_cast<double>(row) + 1.0) / size,
                   r2 = x * x + y * y;
      if (r2 >= 0.98) continue;
      const Frame frame = frameOf(Vec3(x, y, std::sqrt(1.0 - r2)));
      const Vec3 wo = frame.local(Vec3(0, 0, 1));
      const reference::PointSet points(static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(size) +
                                       static_cast<std::uint32_t>(column));
      std::fill(sums.begin(), sums.end(), Vec3(0.0));
      // One sample of each kind at a time, all densities added: the balance heuristic.
      const auto add = [&](const Vec3& wi) {
        if (!(wi.z > 0.0)) return;
        const auto at = light.at(frame.world(wi));
        const double density =
            (light.anyLight() ? at.density : 0.0) + reference::reflectionDensity(sampler, wo, wi) + reference::cosineDensity(wi);
        if (!(density > 0.0)) return;
        for (std::size_t k = 0; k < reflectances.size(); ++k) {
          const Vec3 rho = reflectances[k](wo, wi);
          for (int c = 0; c < 3; ++c)
            if (rho[c] > 0.0) sums[k][c] += rho[c] * wi.z * at.radiance[c] / density;
        }
      };
      for (int i = 0; i < options.samples; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        if (light.anyLight()) add(frame.local(light.sample(points.pair(index, 0))));
        add(reference::sampleReflection(sampler, wo, points.pair(index, 1)));
        add(reference::sampleCosine(points.pair(index, 2)));
      }
      for (int k = 0; k < count; ++k)
        image.at(k * size + column, static_cast<int>(row)) =
            glm::vec4(glm::vec3(sums[static_cast<std::size_t>(k)] / static_cast<double>(options.samples)), 1.0f);
    }
  });
  return image;
}

}  // namespace chiaro
