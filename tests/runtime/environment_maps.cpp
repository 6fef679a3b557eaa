#include "tests/runtime/environment_maps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "runtime/environment/sphere_spectrum.h"
#include "shaders/cpp/lobe.h"

namespace chiaro::test {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

Environment makeEnvironment(int width, int height, int samples, const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
  Environment environment{"made", {width, height, {}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0.0);
      for (int k = 0; k < samples * samples; ++k)
        sum += radiance(lobe64::directionFromEquirect(
            {(x + (k % samples + 0.5) / samples) / width, (y + (k / samples + 0.5) / samples) / height}));
      environment.radiance.texels.push_back(glm::vec3(sum / static_cast<double>(samples * samples)));
    }
  return environment;
}

Environment constantEnvironment(int width, int height, glm::vec3 value) {
  return {"constant",
          {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value)}};
}

Environment noisyEnvironment(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Environment environment = constantEnvironment(width, height, glm::vec3(0.0f));
  const auto uniform = [&] { return static_cast<float>(random() >> 8) / static_cast<float>(1 << 24); };
  for (glm::vec3& texel : environment.radiance.texels)
    texel = glm::vec3(uniform(), uniform(), uniform()) * (uniform() < 0.01f ? 100.0f : 1.0f);
  return environment;
}

Environment discOnSky(int width, glm::dvec3 axis, double angularRadius, double discFlux) {
  axis = glm::normalize(axis);
  const double radiance = discFlux / (2 * kPi * (1 - std::cos(angularRadius)));
  const double margin = angularRadius + 4 * 2 * kPi / width;
  Environment environment =
      makeEnvironment(width, width / 2, 1, [&](const glm::dvec3& w) { return glm::dvec3(0.4, 0.5, 0.8) * (1.0 + 0.5 * w.y); });
  for (int y = 0; y < width / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 centre = lobe64::directionFromEquirect({(x + 0.5) / width, (y + 0.5) / (width / 2)});
      if (glm::length(centre - axis) > margin) continue;
      constexpr int kSamples = 64;
      int inside = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const glm::dvec3 w = lobe64::directionFromEquirect(
            {(x + (k % kSamples + 0.5) / kSamples) / width, (y + (k / kSamples + 0.5) / kSamples) / (width / 2)});
        inside += 2 * std::asin(std::min(1.0, 0.5 * glm::length(w - axis))) <= angularRadius;
      }
      environment.radiance.at(x, y) += static_cast<float>(radiance * inside / (kSamples * kSamples));
    }
  return environment;
}

Environment windowedRoom(int width) {
  struct Window {
    double azimuth, elevation, width, height, radiance;
  };
  const Window windows[] = {
      {0.0, 0.2, 0.35, 0.5, 20}, {0.9, 0.2, 0.25, 0.5, 15}, {-1.1, 0.3, 0.15, 0.6, 30}, {2.6, 0.5, 0.08, 0.08, 60}};
  return makeEnvironment(width, width / 2, 2, [&](const glm::dvec3& w) {
    const double azimuth = std::atan2(w.x, -w.z), elevation = std::asin(std::clamp(w.y, -1.0, 1.0));
    for (const Window& window : windows)
      if (std::abs(azimuth - window.azimuth) < window.width / 2 && std::abs(elevation - window.elevation) < window.height / 2)
        return glm::dvec3(1.0, 1.0, 0.9) * window.radiance;
    return glm::dvec3(0.02 + 0.01 * w.y);
  });
}


double texelSolidAngle(const ImageRgb& map, int row) {
  return 2 * kPi / map.width * (std::cos(kPi * row / map.height) - std::cos(kPi * (row + 1) / map.height));
}

glm::dvec3 fluxOf(const ImageRgb& map) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) sum += texelSolidAngle(map, y) * glm::dvec3(map.at(x, y));
  return sum;
}

glm::dvec3 fluxOf(const SgLight& light) {
  return glm::dvec3(light.amplitude) * lobe64::sgUnitIntegral(static_cast<double>(light.sharpness));
}

glm::dvec3 sumUnderKernel(const ImageRgb& map, const glm::dvec3& direction, double sharpness, int subdivision) {
  const int width = map.width * subdivision, height = map.height * subdivision;
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (int y = 0; y < height; ++y) {
    const double solidAngle = std::cos(kPi * y / height) - std::cos(kPi * (y + 1) / height);
    const double sourceY = std::clamp((y + 0.5) / subdivision - 0.5, 0.0, map.height - 1.0);
    const int top = std::min(static_cast<int>(sourceY), std::max(map.height - 2, 0)), bottom = std::min(top + 1, map.height - 1);
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 w = lobe64::directionFromEquirect({(x + 0.5) / width, (y + 0.5) / height});
      const glm::dvec3 offset = w - direction;
      const double exponent = -0.5 * sharpness * glm::dot(offset, offset);
      if (exponent < -30.0) continue;
      const double sourceX = (x + 0.5) / subdivision - 0.5 + map.width;
      const int left = static_cast<int>(sourceX) % map.width, right = (left + 1) % map.width;
      const double fx = sourceX - std::floor(sourceX), fy = sourceY - top;
      const auto at = [&](int i, int j) { return glm::dvec3(map.at(i, j)); };
      const glm::dvec3 value = (1 - fy) * ((1 - fx) * at(left, top) + fx * at(right, top)) +
                               fy * ((1 - fx) * at(left, bottom) + fx * at(right, bottom));
      const double weight = solidAngle * std::exp(exponent);
      sum += weight * value;
      weights += weight;
    }
  }
  return sum / weights;
}

double explainedShare(const Environment& environment, const std::vector<SgLight>& lights, double sharpness) {
  std::vector<double> band = sgBandFactors(sharpness);
  const std::vector<double> broad = sgBandFactors(32.0);
  for (std::size_t l = 0; l < std::min(band.size(), broad.size()); ++l) band[l] *= 1.0 - broad[l];
  const int rows = 2 * ((static_cast<int>(band.size()) + 1) / 2) * 2;
  const SphereGrid fine = synthesise(analyse(environment.radiance, static_cast<int>(band.size()), 0), band, rows, 0);
  const auto blurred = [](const SgLight& light, const glm::dvec3& w, double kernel) {  // of unit amplitude
    return lobe64::sgInnerProduct(lobe64::sphericalGaussian(glm::dvec3(light.axis), static_cast<double>(light.sharpness), 1.0),
                                  lobe64::sphericalGaussian(w, kernel, lobe64::vmfAmplitude(kernel)));
  };
  double left = 0.0, all = 0.0;
  for (int j = 0; j < fine.height(); ++j)
    for (int i = 0; i < fine.width(); ++i) {
      const glm::dvec3 w = lobe64::directionFromEquirect({(i + 0.5) / fine.width(), (j + 0.5) / fine.height()});
      glm::dvec3 explained(0.0);
      for (const SgLight& light : lights)
        explained += glm::dvec3(light.amplitude) *
                     (blurred(light, w, sharpness) - blurred(light, w, 1.0 / (1.0 / sharpness + 1.0 / 32.0)));
      for (int c = 0; c < 3; ++c) {
        const double value = fine.texel(i, j)[c], rest = value - explained[c];
        const double weight = std::sin(kPi * (j + 0.5) / fine.height());
        left += weight * rest * rest;
        all += weight * value * value;
      }
    }
  return 1.0 - left / all;
}

const std::vector<PrefilteredLevel>& levelsOf(const SgPyramid& pyramid, int layer) {
  return layer == 0 ? pyramid.layer0 : pyramid.layer1;
}

}  // namespace chiaro::test
