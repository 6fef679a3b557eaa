#include "runtime/brdf/albedo_table.h"

#include <algorithm>
#include <cmath>

#include "runtime/parallel.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

Vec3 viewDirection(double cosineOut) { return {std::sqrt(std::max(0.0, 1.0 - cosineOut * cosineOut)), 0.0, cosineOut}; }

double leastCosine(double sqrtCosine) { return std::max(sqrtCosine * sqrtCosine, 1e-3); }

}  // namespace

glm::dvec2 ggxAlbedo(double alpha, double cosineOut) {
  // Half vectors by the distribution D cos: tan^2(theta) = alpha^2 u / (1 - u). The square concentrates points in the tail.
  constexpr int kPolar = 96, kAzimuth = 48;
  const Vec3 wo = viewDirection(cosineOut);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < kPolar; ++i) {
    const double s = 1.0 - (i + 0.5) / kPolar;
    const double u = 1.0 - s * s;
    const double stretch = 2.0 * s / kPolar;
    const double tan2 = alpha * alpha * u / (1.0 - u);
    const double cosine = 1.0 / std::sqrt(1.0 + tan2);
    const double sine = std::sqrt(tan2) * cosine;
    for (int j = 0; j < kAzimuth; ++j) {
      const double phi = (j + 0.5) / kAzimuth * lobe64::kPi;
      const Vec3 wh(sine * std::cos(phi), sine * std::sin(phi), cosine);
      const double cosineDifference = dot(wo, wh);
      const double cosineIn = 2.0 * cosineDifference * wh.z - wo.z;
      if (cosineDifference <= 0.0 || cosineIn <= 0.0) continue;
      const double value = stretch / kAzimuth * 4.0 * lobe64::ggxVisibility(cosineOut, cosineIn, alpha) * cosineIn * cosineDifference / cosine;
      const double f = lobe64::fresnelSchlickWeight(cosineDifference);
      sum += glm::dvec2(value * (1.0 - f), value * f);
    }
  }
  return sum;
}

AlbedoTable makeAlbedoTable(int size, int threads) {
  AlbedoTable table{size, std::vector<glm::vec3>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size))};
  parallelFor(size, threads, [&](int row) {
    const double cosineOut = leastCosine(static_cast<double>(row) / (size - 1));
    const Vec3 wo = viewDirection(cosineOut);
    double diffuse = 0.0;
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
      const double cosineIn = std::sqrt((i + 0.5) / kSteps);
      for (int j = 0; j < kSteps; ++j) {
        const double phi = (j + 0.5) / kSteps * lobe64::kPi;
        const double sine = std::sqrt(1.0 - cosineIn * cosineIn);
        const Vec3 wh = glm::normalize(wo + Vec3(sine * std::cos(phi), sine * std::sin(phi), cosineIn));
        diffuse += lobe64::fresnelSchlickWeight(dot(wo, wh)) / (kSteps * kSteps);
      }
    }
    for (int i = 0; i < size; ++i) {
      const double roughness = std::max(static_cast<double>(i) / (size - 1), 0.03);
      const auto albedo = ggxAlbedo(roughness * roughness, cosineOut);
      table.entries[static_cast<std::size_t>(row * size + i)] = glm::vec3(glm::dvec3(albedo, diffuse));
    }
  });
  return table;
}

const AlbedoTable& sharedAlbedoTable() {
  static const AlbedoTable table = makeAlbedoTable();
  return table;
}

}  // namespace chiaro
