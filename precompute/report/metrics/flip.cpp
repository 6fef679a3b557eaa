#include "precompute/report/metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "precompute/report/metrics/flip_color.h"
#include "precompute/report/metrics/separable_filter.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using Opponent = std::array<Plane, 3>;  // Y, Cx, Cz

/// A contrast sensitivity function in the frequency domain: a sum of Gaussians a exp(-b f^2), f in cycles a degree.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1.0, 0.0047, 0.0, 1e-5}, kRedGreen{1.0, 0.0053, 0.0, 1e-5},
    kBlueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double kWidestB = 0.04;
constexpr double kFeatureWidth = 0.082;  // degrees, peak to trough of the edge detector
constexpr double kFeatureExponent = 0.5;

double square(double x) { return x * x; }

Opponent opponentOf(const ImageRgb& shown, const ImageRgb& other, int threads) {
  Opponent planes{Plane(shown.width, shown.height), Plane(shown.width, shown.height), Plane(shown.width, shown.height)};
  forEachRow(shown.height, threads, [&](int y) {
    for (int x = 0; x < shown.width; ++x) {
      glm::dvec3 linear(0.0);
      if (isFinite(shown.at(x, y)) && isFinite(other.at(x, y)))
        for (int c = 0; c < 3; ++c) linear[c] = lobe64::srgbDecode(shown.at(x, y)[c]);  // clamps
      const glm::dvec3 color = flip::yCxCzFromLinear(linear);
      for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].at(x, y) = color[c];
    }
  });
  return planes;
}

/// Filtered by one Gaussian exp(-pi^2 x^2 / b), x in degrees, that sums to 1.
Plane gaussian(const Plane& plane, double b, const FlipSettings& settings) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestB / 2.0) / std::numbers::pi * settings.pixelsPerDegree));
  const Taps taps =
      normalised(tapsOf(radius, [&](int k) { return std::exp(-square(std::numbers::pi * k / settings.pixelsPerDegree) / b); }));
  return filterAlongY(filterAlongX(plane, taps, Border::nearest, settings.threads), taps, Border::nearest, settings.threads);
}

/// What a Gaussian's taps sum to over the square of both axes, so that two of them keep their share of a sum that is 1.
double mass(double a, double b, const FlipSettings& settings) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestB / 2.0) / std::numbers::pi * settings.pixelsPerDegree));
  double sum = 0.0;
  for (int k = -radius; k <= radius; ++k) sum += std::exp(-square(std::numbers::pi * k / settings.pixelsPerDegree) / b);
  return a * std::sqrt(std::numbers::pi / b) * sum * sum;
}

Plane sensed(const Plane& plane, const Sensitivity& s, const FlipSettings& settings) {
  Plane result = gaussian(plane, s.b1, settings);
  if (s.a2 == 0.0) return result;
  const Plane second = gaussian(plane, s.b2, settings);
  const double m1 = mass(s.a1, s.b1, settings), m2 = mass(s.a2, s.b2, settings);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = (m1 * result.values[i] + m2 * second.values[i]) / (m1 + m2);
  return result;
}

/// Colours as they blur at the viewer's distance, in the space where they are compared.
std::vector<glm::dvec3> perceived(const Opponent& picture, const FlipSettings& settings) {
  const Plane y = sensed(picture[0], kAchromatic, settings), cx = sensed(picture[1], kRedGreen, settings),
              cz = sensed(picture[2], kBlueYellow, settings);
  std::vector<glm::dvec3> colors(y.values.size());
  forEachRow(y.height, settings.threads, [&](int row) {
    for (std::size_t i = y.index(0, row); i < y.index(0, row + 1); ++i)
      colors[i] = flip::huntLabFromLinear(
          glm::clamp(flip::linearFromYCxCz({y.values[i], cx.values[i], cz.values[i]}), glm::dvec3(0.0), glm::dvec3(1.0)));
  });
  return colors;
}

/// Positive weights sum to 1, negative ones to -1.
Taps balanced(Taps taps) {
  double up = 0.0, down = 0.0;
  for (const double tap : taps) (tap > 0.0 ? up : down) += std::abs(tap);
  for (double& tap : taps) tap /= tap > 0.0 ? up : down;
  return taps;
}

struct Features {
  std::vector<double> edges, points;  // how strong, at each pixel
};

Features featuresOf(const Plane& luminance, const FlipSettings& settings) {
  const double deviation = 0.5 * kFeatureWidth * settings.pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  const auto bell = [&](int k) { return std::exp(-0.5 * square(k / deviation)); };
  const Taps smooth = normalised(tapsOf(radius, bell));
  const Taps slope = balanced(tapsOf(radius, [&](int k) { return -k * bell(k); }));
  const Taps bend = balanced(tapsOf(radius, [&](int k) { return (square(k / deviation) - 1.0) * bell(k); }));
  const auto strength = [&](const Taps& detector) {
    const auto along = [&](const Taps& x, const Taps& y) {
      return filterAlongY(filterAlongX(luminance, x, Border::nearest, settings.threads), y, Border::nearest, settings.threads);
    };
    const Plane inX = along(detector, smooth), inY = along(smooth, detector);
    std::vector<double> both(inX.values.size());
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = std::hypot(inX.values[i], inY.values[i]);
    return both;
  };
  return {strength(slope), strength(bend)};
}

/// Luminance in [0,1].
Plane normalisedLuminance(Plane y) {
  for (double& value : y.values) value = (value + 16.0) / 116.0;
  return y;
}

double luminanceOf(const glm::vec3& radiance) { return luminance(glm::max(glm::dvec3(radiance), glm::dvec3(0.0))); }

// (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5): Narkowicz's fit of ACES with his exposure of .6 inside.
constexpr double kK0 = 0.6 * 0.6 * 2.51, kK1 = 0.6 * 0.03, kK3 = 0.6 * 0.6 * 2.43, kK4 = 0.6 * 0.59, kK5 = 0.14;

double toneMapped(double x) {
  if (!(x < 1e12)) return 1.0;  // its square would not be a number
  return std::clamp((kK0 * x * x + kK1 * x) / (kK3 * x * x + kK4 * x + kK5), 0.0, 1.0);
}

/// What the tone map shows at `shown`: the positive root of (k0 - k3 t) x^2 + (k1 - k4 t) x - k5 t.
double radianceShownAt(double shown) {
  const double a = kK0 - kK3 * shown, half = 0.5 * (kK1 - kK4 * shown) / a;
  return -half + std::sqrt(half * half + kK5 * shown / a);
}

ImageRgb exposed(const ImageRgb& radiance, double exposure, int threads) {
  ImageRgb shown = radiance;
  const double factor = std::exp2(exposure);
  forEachRow(radiance.height, threads, [&](int y) {
    for (int x = 0; x < radiance.width; ++x) {
      if (!isFinite(radiance.at(x, y))) continue;
      for (int c = 0; c < 3; ++c)
        shown.at(x, y)[c] =
            static_cast<float>(lobe64::srgbEncode(toneMapped(factor * std::max(0.0, static_cast<double>(radiance.at(x, y)[c])))));
    }
  });
  return shown;
}

}  // namespace

MetricMap ldrFlip(const ImageRgb& reference, const ImageRgb& test, const FlipSettings& settings) {
  requireComparable(reference, test);
  const Opponent truth = opponentOf(reference, test, settings.threads), ours = opponentOf(test, reference, settings.threads);
  const auto truthColors = perceived(truth, settings), ourColors = perceived(ours, settings);
  const Features truthFeatures = featuresOf(normalisedLuminance(truth[0]), settings),
                 ourFeatures = featuresOf(normalisedLuminance(ours[0]), settings);
  MetricMap map{Plane(reference.width, reference.height), 0};
  forEachRow(reference.height, settings.threads, [&](int y) {
    for (int x = 0; x < reference.width; ++x) {
      const std::size_t i = map.plane.index(x, y);
      if (!isFinite(reference.texels[i]) || !isFinite(test.texels[i])) {
        map.plane.values[i] = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      const double color = flip::remappedDistance(flip::colorDistance(truthColors[i], ourColors[i]));
      const double feature = std::max(std::abs(truthFeatures.edges[i] - ourFeatures.edges[i]),
                                      std::abs(truthFeatures.points[i] - ourFeatures.points[i]));
      map.plane.values[i] = std::pow(color, 1.0 - std::pow(std::min(1.0, feature / std::numbers::sqrt2), kFeatureExponent));
    }
  });
  return map;
}

ExposureRange exposureRangeOf(const ImageRgb& reference, const PixelMask& mask) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i < reference.texels.size(); ++i)
    if ((mask.empty() || mask[i] != 0) && isFinite(reference.texels[i])) luminances.push_back(luminanceOf(reference.texels[i]));
  std::sort(luminances.begin(), luminances.end());
  if (luminances.empty() || !(luminances.back() > 0.0)) return {};
  const std::size_t middle = luminances.size() / 2;
  const double median = luminances.size() % 2 == 1 ? luminances[middle] : 0.5 * (luminances[middle - 1] + luminances[middle]);
  const double target = radianceShownAt(0.85);
  ExposureRange range;
  range.start = std::log2(target / luminances.back());
  range.stop = std::min(range.start + kMostStops, std::log2(target / median));
  range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
  return range;
}

HdrFlip hdrFlip(const ImageRgb& reference, const ImageRgb& test, const PixelMask& mask, const FlipSettings& settings) {
  requireComparable(reference, test);
  HdrFlip result;
  result.range = exposureRangeOf(reference, mask);
  for (int i = 0; i < result.range.count; ++i) {
    const double exposure = result.range.at(i);
    MetricMap map = ldrFlip(exposed(reference, exposure, settings.threads), exposed(test, exposure, settings.threads), settings);
    if (i > 0)
      for (std::size_t k = 0; k < map.plane.values.size(); ++k)  // NaN in one is NaN in all
        map.plane.values[k] = std::max(map.plane.values[k], result.map.plane.values[k]);
    result.map = std::move(map);
  }
  return result;
}

}  // namespace chiaro
