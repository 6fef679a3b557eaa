#include "runtime/brdf/specular_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/parallel.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using lobe64::Vec3;
constexpr int kLobes = SpecularTable::kLobeCount;
constexpr int kStrung = 5;  // lobes strung per mixture term
constexpr int kTerms = kLobes / kStrung;

/// A light direction with what the slice of the BRDF is there. The viewer is in the xz plane, n = z.
struct SliceSample {
  Vec3 wi;
  double solidAngle;
  double value;    // D V cos
  double fresnel;  // (1 - wo.wh)^5
};

Vec3 viewDirection(double cosineOut) { return {std::sqrt(std::max(0.0, 1.0 - cosineOut * cosineOut)), 0.0, cosineOut}; }

/// Half vectors on a grid that is dense at the peak and reaches pi/2, mirrored about the plane of incidence by weight.
std::vector<SliceSample> sampleSlice(double alpha, double cosineOut, int polar, int azimuth) {
  const Vec3 wo = viewDirection(cosineOut);
  std::vector<SliceSample> samples;
  samples.reserve(static_cast<std::size_t>(polar) * static_cast<std::size_t>(azimuth));
  const double scale = 0.3 * alpha;
  const double top = std::log1p(lobe64::kHalfPi / scale);
  for (int i = 0; i < polar; ++i) {
    const double t = (i + 0.5) / polar;
    const double theta = scale * std::expm1(t * top);
    const double thetaStep = scale * std::exp(t * top) * top / polar;
    for (int j = 0; j < azimuth; ++j) {
      const double phi = (j + 0.5) / azimuth * lobe64::kPi;
      const Vec3 wh(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cosineDifference = dot(wo, wh);
      if (cosineDifference < 1e-4) continue;
      const Vec3 wi = 2.0 * cosineDifference * wh - wo;
      const double solidAngle = 2.0 * std::sin(theta) * thetaStep * (lobe64::kPi / azimuth) * 4.0 * cosineDifference;
      const double value =
          wi.z > 0.0 ? lobe64::ggxDistribution(wh.z, alpha) * lobe64::ggxVisibility(cosineOut, wi.z, alpha) * wi.z : 0.0;
      samples.push_back({wi, solidAngle, value, lobe64::fresnelSchlickWeight(cosineDifference)});
    }
  }
  return samples;
}

using Matrix = std::array<std::array<double, kLobes>, kLobes>;
using Vector = std::array<double, kLobes>;

/// min |B x - g|^2, x >= 0, from the normal equations, by cyclic coordinate descent (Franc, Hlavac and Navara 2005); the problem is convex.
Vector nonNegativeLeastSquares(const Matrix& gram, const Vector& right) {
  Vector x{};
  Vector gradient;
  for (std::size_t k = 0; k < kLobes; ++k) gradient[k] = -right[k];
  for (int sweep = 0; sweep < 400; ++sweep) {
    double largest = 0.0;
    for (std::size_t k = 0; k < kLobes; ++k) {
      if (!(gram[k][k] > 0.0)) continue;
      const double moved = std::max(0.0, x[k] - gradient[k] / gram[k][k]) - x[k];
      if (moved == 0.0) continue;
      x[k] += moved;
      largest = std::max(largest, moved * moved * gram[k][k]);
      for (std::size_t m = 0; m < kLobes; ++m) gradient[m] += moved * gram[k][m];
    }
    if (largest < 1e-14) break;
  }
  return x;
}

struct FittedLobe {
  double angle;  // from the mirror direction towards n
  double sharpness;
  double weight;
  double fresnelWeight;
};

std::array<FittedLobe, kLobes> fitSlice(double alpha, double cosineOut) {
  const Vec3 n(0, 0, 1), wo = viewDirection(cosineOut);
  std::array<FittedLobe, kLobes> lobes{};
  std::array<Vec3, kLobes> axes;
  const double mirrorAngle = std::acos(std::clamp(cosineOut, -1.0, 1.0));
  for (int term = 0; term < kTerms; ++term) {
    const double halfSharpness = 2.0 * lobe64::ggxMixtureTerm(kTerms, term).y * lobe64::ggxCurvature(alpha) + lobe64::kBroadestHalfLobe;
    const auto halfLobe = lobe64::sphericalGaussian(n, halfSharpness, 1.0);
    for (int part = 0; part < kStrung; ++part) {
      const auto lobe = lobe64::sgWarpLobe(halfLobe, wo, kStrung, part);
      const auto k = static_cast<std::size_t>(term * kStrung + part);
      axes[k] = lobe64::cosineWeightedAxis(lobe.axis, lobe.sharpness, n);
      lobes[k].angle = mirrorAngle - std::atan2(-axes[k].x, axes[k].z);
      lobes[k].sharpness = lobe.sharpness;
    }
  }

  const auto samples = sampleSlice(alpha, cosineOut, 72, 32);
  double peak = 0.0;
  for (const auto& s : samples) peak = std::max(peak, s.value);
  Matrix gram{};
  Vector right{}, rightFresnel{};
  Vector values;
  for (const auto& s : samples) {
    for (std::size_t k = 0; k < kLobes; ++k)
      values[k] = lobe64::sgEvaluate(lobe64::sphericalGaussian(axes[k], lobes[k].sharpness, 1.0), s.wi);
    // Between absolute and relative error: tails count, for a sun shines through them.
    const double weight = s.solidAngle / std::sqrt(s.value / peak + 0.01);
    for (std::size_t k = 0; k < kLobes; ++k) {
      for (std::size_t m = 0; m <= k; ++m) gram[k][m] += weight * values[k] * values[m];
      right[k] += weight * values[k] * s.value * (1.0 - s.fresnel);
      rightFresnel[k] += weight * values[k] * s.value * s.fresnel;
    }
  }
  for (std::size_t k = 0; k < kLobes; ++k)
    for (std::size_t m = k + 1; m < kLobes; ++m) gram[k][m] = gram[m][k];
  const Vector base = nonNegativeLeastSquares(gram, right);
  const Vector fresnel = nonNegativeLeastSquares(gram, rightFresnel);

  double baseSum = 0.0, fresnelSum = 0.0;
  for (std::size_t k = 0; k < kLobes; ++k) {
    const double integral = lobe64::sgUnitIntegral(lobes[k].sharpness);
    lobes[k].weight = base[k] * integral;
    lobes[k].fresnelWeight = fresnel[k] * integral;
    baseSum += lobes[k].weight;
    fresnelSum += lobes[k].fresnelWeight;
  }
  const glm::dvec2 albedo = ggxAlbedo(alpha, cosineOut);
  for (auto& lobe : lobes) {
    lobe.weight *= baseSum > 0.0 ? albedo.x / baseSum : 0.0;
    lobe.fresnelWeight *= fresnelSum > 0.0 ? albedo.y / fresnelSum : 0.0;
  }
  return lobes;
}

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

SpecularTable makeSpecularTable(int roughnessCount, int cosineCount, int threads) {
  SpecularTable table{roughnessCount, cosineCount, {}};
  const int layer = roughnessCount * cosineCount;
  table.entries.resize(static_cast<std::size_t>(layer) * kLobes);
  parallelFor(layer, threads, [&](int texel) {
    const double roughness =
        lobe64::kTableMinRoughness + (lobe64::kTableMaxRoughness - lobe64::kTableMinRoughness) * (texel % roughnessCount) / (roughnessCount - 1);
    const double alpha = roughness * roughness;
    const double cosineOut = leastCosine(static_cast<double>(texel / roughnessCount) / (cosineCount - 1));
    const auto lobes = fitSlice(alpha, cosineOut);
    for (int k = 0; k < kLobes; ++k) {
      const auto& lobe = lobes[static_cast<std::size_t>(k)];
      table.entries[static_cast<std::size_t>(k * layer + texel)] =
          glm::vec4(glm::dvec4(lobe.angle / alpha, std::log2(lobe.sharpness * alpha * alpha), lobe.weight, lobe.fresnelWeight));
    }
  });
  return table;
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

}  // namespace chiaro
