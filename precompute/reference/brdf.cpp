#include "precompute/reference/brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chiaro::reference {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalfPi = 0.5 * kPi;
constexpr double kCoatF0 = 0.04;

double pow5(double x) { return x * x * x * x * x; }

double exponentOf(double alpha) {
  return std::clamp(2.0 / (alpha * alpha) - 2.0, static_cast<double>(kLeastExponent), static_cast<double>(kMostExponent));
}

glm::dvec3 fresnel(const Brdf& brdf, double cosine) {
  return brdf.f0 + (brdf.f90 - brdf.f0) * pow5(1.0 - std::clamp(cosine, 0.0, 1.0));
}

double largest(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

/// tan^2 of the half vector in units of the widths.
double slope2(const Brdf& brdf, glm::dvec3 wh) {
  const double x = wh.x / brdf.alphaX, y = wh.y / brdf.alphaY;
  return (x * x + y * y) / (wh.z * wh.z);
}

/// Ashikhmin and Shirley's exponent along the half vector's azimuth.
double exponentAlong(double nx, double ny, double x, double y) {
  const double across = x * x + y * y;
  return across > 0.0 ? (nx * x * x + ny * y * y) / across : nx;
}

double ggxDistribution(double alphaX, double alphaY, glm::dvec3 wh) {
  const double x = wh.x / alphaX, y = wh.y / alphaY;
  const double s = x * x + y * y + wh.z * wh.z;
  return 1.0 / (kPi * alphaX * alphaY * s * s);
}

/// |(alphaX x, alphaY y, z)| = z (1 + 2 Lambda(w)): Smith's masking of GGX without a division by z.
double stretched(double alphaX, double alphaY, glm::dvec3 w) { return std::hypot(alphaX * w.x, alphaY * w.y, w.z); }

/// G / (4 wi.z wo.z) with G = 1 / (1 + Lambda(wo) + Lambda(wi)).
double ggxVisibility(double alphaX, double alphaY, glm::dvec3 wo, glm::dvec3 wi) {
  return 0.5 / (wi.z * stretched(alphaX, alphaY, wo) + wo.z * stretched(alphaX, alphaY, wi));
}

/// Smith's Lambda for Beckmann's distribution: slopes are Gaussian.
double beckmannLambda(const Brdf& brdf, glm::dvec3 w) {
  const double across = std::hypot(brdf.alphaX * w.x, brdf.alphaY * w.y);
  if (!(across > 0.0)) return 0.0;
  const double a = w.z / across;
  return std::max(0.0, std::exp(-a * a) / (2.0 * a * std::sqrt(kPi)) - 0.5 * std::erfc(a));
}

/// The reflection with Fresnel 1, times wi.z; both directions above the surface.
double reflectionTimesCosine(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi, glm::dvec3 wh) {
  const double outHalf = glm::dot(wo, wh);
  switch (brdf.model) {
    case Reflectance::ggx:
      return ggxDistribution(brdf.alphaX, brdf.alphaY, wh) * ggxVisibility(brdf.alphaX, brdf.alphaY, wo, wi) * wi.z;
    case Reflectance::cookTorrance: {
      const double m = brdf.alphaX, angle = std::atan2(std::hypot(wh.x, wh.y), wh.z);
      const double groove = 2.0 * wh.z / outHalf;
      const double masking = std::min({1.0, groove * wo.z, groove * wi.z});
      return std::exp(-angle * angle / (m * m)) / (kPi * m * m) * masking / (4.0 * wo.z);
    }
    case Reflectance::beckmann: {
      const double cosine2 = wh.z * wh.z;
      const double d = std::exp(-slope2(brdf, wh)) / (kPi * brdf.alphaX * brdf.alphaY * cosine2 * cosine2);
      return d / (1.0 + beckmannLambda(brdf, wo) + beckmannLambda(brdf, wi)) / (4.0 * wo.z);
    }
    case Reflectance::blinnPhong: {
      const double n = exponentOf(brdf.alphaX);
      return (n + 2.0) * (n + 4.0) / (8.0 * kPi * (std::exp2(-0.5 * n) + n)) * std::pow(wh.z, n) * wi.z;
    }
    case Reflectance::ward:
      return std::exp(-slope2(brdf, wh)) / (4.0 * kPi * brdf.alphaX * brdf.alphaY) * std::sqrt(wi.z / wo.z);
    case Reflectance::ashikhminShirley: {
      const double nx = exponentOf(brdf.alphaX), ny = exponentOf(brdf.alphaY);
      return std::sqrt((nx + 1.0) * (ny + 1.0)) * std::pow(wh.z, exponentAlong(nx, ny, wh.x, wh.y)) /
             (8.0 * kPi * outHalf * std::max(wo.z, wi.z)) * wi.z;
    }
  }
  return 0.0;
}

// ---- half vectors ----

glm::dvec3 fromAngles(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// Of a density like the model's own distribution times the cosine.
glm::dvec3 sampleHalf(const Brdf& brdf, glm::dvec2 random) {
  const double azimuth = 2.0 * kPi * random.y;
  switch (brdf.model) {
    case Reflectance::cookTorrance: {
      // theta e^(-theta^2 / m^2) up to a right angle
      const double m = brdf.alphaX, end = -std::expm1(-kHalfPi * kHalfPi / (m * m));
      return fromAngles(std::cos(m * std::sqrt(-std::log1p(-random.x * end))), azimuth);
    }
    case Reflectance::blinnPhong:
      return fromAngles(std::pow(random.x, 1.0 / (exponentOf(brdf.alphaX) + 1.0)), azimuth);
    case Reflectance::ashikhminShirley: {
      const double nx = exponentOf(brdf.alphaX), ny = exponentOf(brdf.alphaY);
      // Their equation 9 in each quadrant: the tangent of a uniform angle, stretched.
      const double x = std::sqrt(ny + 1.0) * std::cos(azimuth), y = std::sqrt(nx + 1.0) * std::sin(azimuth);
      return fromAngles(std::pow(random.x, 1.0 / (exponentAlong(nx, ny, x, y) + 1.0)), std::atan2(y, x));
    }
    default: {  // Gaussian slopes: Beckmann, Ward
      const double radius = std::sqrt(-std::log(random.x));
      return glm::normalize(glm::dvec3(brdf.alphaX * radius * std::cos(azimuth), brdf.alphaY * radius * std::sin(azimuth), 1.0));
    }
  }
}

/// Its density over half vectors, wh.z > 0.
double halfDensity(const Brdf& brdf, glm::dvec3 wh) {
  switch (brdf.model) {
    case Reflectance::cookTorrance: {
      const double m = brdf.alphaX, sine = std::hypot(wh.x, wh.y), angle = std::atan2(sine, wh.z);
      const double perSine = sine > 1e-9 ? angle / sine : 1.0;
      return perSine * std::exp(-angle * angle / (m * m)) / (kPi * m * m * -std::expm1(-kHalfPi * kHalfPi / (m * m)));
    }
    case Reflectance::blinnPhong: {
      const double n = exponentOf(brdf.alphaX);
      return (n + 1.0) / (2.0 * kPi) * std::pow(wh.z, n);
    }
    case Reflectance::ashikhminShirley: {
      const double nx = exponentOf(brdf.alphaX), ny = exponentOf(brdf.alphaY);
      return std::sqrt((nx + 1.0) * (ny + 1.0)) / (2.0 * kPi) * std::pow(wh.z, exponentAlong(nx, ny, wh.x, wh.y));
    }
    default:
      return std::exp(-slope2(brdf, wh)) / (kPi * brdf.alphaX * brdf.alphaY * wh.z * wh.z * wh.z);
  }
}

/// The reflection of wo at a visible normal of a GGX surface.
glm::dvec3 sampleVisibleNormal(double alphaX, double alphaY, glm::dvec3 wo, glm::dvec2 random) {
  // In the space where the surface is a hemisphere, its visible part is a half disc and a half ellipse seen along wo.
  const glm::dvec3 view = glm::normalize(glm::dvec3(alphaX * wo.x, alphaY * wo.y, wo.z));
  const double across = view.x * view.x + view.y * view.y;
  const glm::dvec3 first = across > 0.0 ? glm::dvec3(-view.y, view.x, 0.0) / std::sqrt(across) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 second = glm::cross(view, first);
  const double radius = std::sqrt(random.x);
  const double angle = 2.0 * kPi * random.y;
  const double a = radius * std::cos(angle);
  const double share = 0.5 * (1.0 + view.z);
  const double b = (1.0 - share) * std::sqrt(std::max(0.0, 1.0 - a * a)) + share * radius * std::sin(angle);
  const glm::dvec3 onSphere = a * first + b * second + std::sqrt(std::max(0.0, 1.0 - a * a - b * b)) * view;
  return glm::normalize(glm::dvec3(alphaX * onSphere.x, alphaY * onSphere.y, std::max(onSphere.z, 0.0)));
}

glm::dvec3 mirrored(glm::dvec3 wo, glm::dvec3 wh) { return glm::normalize(2.0 * glm::dot(wo, wh) * wh - wo); }

double visibleNormalDensity(double alphaX, double alphaY, glm::dvec3 wo, glm::dvec3 wi) {
  const glm::dvec3 sum = wo + wi;
  const double length = glm::length(sum);
  if (!(length > 0.0 && sum.z > 0.0)) return 0.0;
  // G1(wo) / wo.z = 2 / (wo.z + stretched(wo))
  return ggxDistribution(alphaX, alphaY, sum / length) / (2.0 * (wo.z + stretched(alphaX, alphaY, wo)));
}

/// Estevez and Kulla's fitted shadowing, their equation 3: coefficients between those of roughness 0 and 1.
double sheenLambda(double alpha, double cosine) {
  const double t = (1.0 - alpha) * (1.0 - alpha);
  const double a = std::lerp(21.5473, 25.3245, t), b = std::lerp(3.82987, 3.32435, t), c = std::lerp(0.19823, 0.16801, t),
               d = std::lerp(-1.97760, -1.27393, t), e = std::lerp(-4.32054, -4.85967, t);
  const auto fit = [&](double x) { return a / (1.0 + b * std::pow(x, c)) + d * x + e; };
  return std::exp(cosine < 0.5 ? fit(cosine) : 2.0 * fit(0.5) - fit(1.0 - cosine));
}

/// D V wi.z of a sheen.
double sheenTimesCosine(double alpha, double cosineOut, double cosineIn, double cosineHalf) {
  const double sine2 = std::max(0.0, 1.0 - cosineHalf * cosineHalf);
  const double d = (2.0 + 1.0 / alpha) * std::pow(sine2, 0.5 / alpha) / (2.0 * kPi);
  return d / ((1.0 + sheenLambda(alpha, cosineOut) + sheenLambda(alpha, cosineIn)) * 4.0 * cosineOut);
}

/// Columns: an orthonormal frame about the coat's normal.
glm::dmat3 coatFrame(const Brdf& brdf) {
  const glm::dvec3 n = brdf.coatNormal;
  const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 t = glm::normalize(axis - n * glm::dot(n, axis));
  return {t, glm::cross(n, t), n};
}

}  // namespace

double sheenAlbedo(double alpha, double cosineOut) {
  constexpr int kRows = 24, kColumns = 24;
  const glm::dvec3 wo(std::sqrt(std::max(0.0, 1.0 - cosineOut * cosineOut)), 0.0, cosineOut);
  double sum = 0.0;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kColumns; ++j) {
      // Midpoints, dense towards the horizon where smooth fuzz shines.
      const double u = (i + 0.5) / kRows, cosine = u * u, sine = std::sqrt(1.0 - cosine * cosine), phi = (j + 0.5) / kColumns * kPi;
      const glm::dvec3 wi(sine * std::cos(phi), sine * std::sin(phi), cosine);
      sum += 2.0 * u * sheenTimesCosine(alpha, cosineOut, cosine, glm::normalize(wo + wi).z);
    }
  return std::min(1.0, sum * 2.0 * kPi / (kRows * kColumns));
}

double coatWeight(const Brdf& brdf, glm::dvec3 wo) {
  if (!(brdf.coat > 0.0)) return 0.0;
  const double cosine = std::clamp(glm::dot(brdf.coatNormal, wo), 0.0, 1.0);
  return brdf.coat * (kCoatF0 + (1.0 - kCoatF0) * pow5(1.0 - cosine));
}

glm::dvec3 brdfTimesCosine(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi) {
  glm::dvec3 sum(0.0);
  const glm::dvec3 wh = glm::normalize(wo + wi);
  const double coat = coatWeight(brdf, wo);
  if (wi.z > 0.0 && wo.z > 0.0) {
    const glm::dvec3 f = fresnel(brdf, glm::dot(wo, wh));
    sum = f * brdf.gain * reflectionTimesCosine(brdf, wo, wi, wh) + (1.0 - largest(f)) * brdf.diffuse / kPi * wi.z;
    if (largest(brdf.sheen) > 0.0)
      sum = (1.0 - largest(brdf.sheen) * brdf.sheenAlbedo) * sum + brdf.sheen * sheenTimesCosine(brdf.sheenAlpha, wo.z, wi.z, wh.z);
    sum *= 1.0 - coat;
  }
  if (!(coat > 0.0)) return sum;
  const glm::dvec3 out = wo * coatFrame(brdf), in = wi * coatFrame(brdf), half = wh * coatFrame(brdf);
  if (in.z > 0.0 && out.z > 0.0)
    sum += coat * ggxDistribution(brdf.coatAlpha, brdf.coatAlpha, half) * ggxVisibility(brdf.coatAlpha, brdf.coatAlpha, out, in) * in.z;
  return sum;
}

glm::dvec3 sampleCosine(glm::dvec2 random) {
  const double radius = std::sqrt(random.x);
  const double angle = 2.0 * kPi * random.y;
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0, 1.0 - random.x))};
}

double cosineDensity(glm::dvec3 wi) { return std::max(wi.z, 0.0) / kPi; }

glm::dvec3 sampleReflection(const Brdf& brdf, glm::dvec3 wo, glm::dvec2 random) {
  return mirrored(wo, brdf.model == Reflectance::ggx ? sampleVisibleNormal(brdf.alphaX, brdf.alphaY, wo, random) : sampleHalf(brdf, random));
}

double reflectionDensity(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi) {
  if (brdf.model == Reflectance::ggx) return visibleNormalDensity(brdf.alphaX, brdf.alphaY, wo, wi);
  const glm::dvec3 sum = wo + wi;
  const double length = glm::length(sum);
  if (!(length > 1e-12 && sum.z != 0.0)) return 0.0;
  // A half vector that faces away from the viewer mirrors it to below the horizon, where the sum points down.
  const glm::dvec3 wh = sum / (sum.z > 0.0 ? length : -length);
  return halfDensity(brdf, wh) / (4.0 * std::abs(glm::dot(wo, wh)));
}

glm::dvec3 sampleCoat(const Brdf& brdf, glm::dvec3 wo, glm::dvec2 random) {
  const glm::dmat3 frame = coatFrame(brdf);
  const glm::dvec3 out = wo * frame;
  return frame * mirrored(out, sampleVisibleNormal(brdf.coatAlpha, brdf.coatAlpha, out, random));
}

double coatDensity(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi) {
  const glm::dmat3 frame = coatFrame(brdf);
  return visibleNormalDensity(brdf.coatAlpha, brdf.coatAlpha, wo * frame, wi * frame);
}

double reflectionShare(const Brdf& brdf, glm::dvec3 wo) {
  const glm::dvec3 f = fresnel(brdf, wo.z);
  const double reflected = f.x + f.y + f.z;
  const glm::dvec3 scattered = (1.0 - largest(f)) * brdf.diffuse + brdf.sheen * brdf.sheenAlbedo;
  const double total = reflected + scattered.x + scattered.y + scattered.z;
  if (!(total > reflected)) return 1.0;
  if (!(reflected > 0.0)) return 0.0;
  // Never all of one kind: at grazing angles or in the lobe's tail the other one is the better sampler.
  return std::clamp(reflected / total, 0.25, 0.9);
}

double coatShare(const Brdf& brdf, glm::dvec3 wo) {
  const double coat = coatWeight(brdf, wo);
  return coat > 0.0 ? std::clamp(coat, 0.15, 0.7) : 0.0;
}

double ggxAlbedo(const Brdf& brdf, glm::dvec3 wo) {
  constexpr int kRows = 16;
  double sum = 0.0;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kRows; ++j) {
      // Every row turned by its share of a step: no column of points.
      const glm::dvec2 random((i + 0.5) / kRows, std::fmod((j + 0.5 + (i * 5 % kRows) / static_cast<double>(kRows)) / kRows, 1.0));
      const glm::dvec3 wi = mirrored(wo, sampleVisibleNormal(brdf.alphaX, brdf.alphaY, wo, random));
      if (!(wi.z > 0.0)) continue;
      // D V wi.z over its density is G2 / G1
      sum += ggxVisibility(brdf.alphaX, brdf.alphaY, wo, wi) * wi.z * 2.0 * (wo.z + stretched(brdf.alphaX, brdf.alphaY, wo));
    }
  return sum / (kRows * kRows);
}

glm::dvec3 multipleScatteringGain(const Brdf& brdf, glm::dvec3 wo) {
  if (brdf.model != Reflectance::ggx || !(wo.z > 0.0)) return glm::dvec3(1.0);
  return 1.0 + brdf.f0 * (1.0 / std::clamp(ggxAlbedo(brdf, wo), 1e-3, 1.0) - 1.0);
}

}  // namespace chiaro::reference
