/// The reflectance models and their SG mixtures, double C++ against textbook forms and quadrature; and a million extremes.

#include <gtest/gtest.h>

#include <random>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using namespace lobe64;
using quadrature::kPi;

Vec3 polar(double theta, double phi) { return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}; }

/// Integral of f(wh) over the upper hemisphere, dense at the peak of a lobe of widths wx, wy: in slopes, radius on a log scale.
template <class F>
double overHalfVectors(double wx, double wy, F f) {
  const int azimuths = 64;
  double sum = 0;
  for (int k = 0; k < azimuths; ++k) {
    const double phi = 2 * kPi * (k + 0.5) / azimuths;
    sum += quadrature::integrate(
        [&](double logR) {
          const double r = std::exp(logR), x = wx * r * std::cos(phi), y = wy * r * std::sin(phi), z = 1 / std::sqrt(1 + x * x + y * y);
          return f(Vec3(x * z, y * z, z)) * wx * wy * r * r * z * z * z;
        },
        std::log(1e-6), std::log(1e5 / std::min(wx, wy)), 12);
  }
  return sum * 2 * kPi / azimuths;
}

/// Directional albedo, F = 1.
double albedo(const ReflectanceModel& m, const Vec3& wo) {
  const auto width = [&](double x) { return modelHasExponent(m.kind) ? std::sqrt(2 / (x + 1)) : x; };
  return overHalfVectors(width(m.x), width(m.y), [&](const Vec3& wh) {
    const double c = dot(wo, wh);
    return c > 0 ? 4 * c * modelTimesCosine(m, wo, 2.0 * c * wh - wo) : 0.0;
  });
}

TEST(Models, TextbookForms) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 wo = polar(std::acos(1e-3 + .999 * unit(engine)), 2 * kPi * unit(engine)), wi = polar(std::acos(1e-3 + .999 * unit(engine)), 2 * kPi * unit(engine));
    const Vec3 wh = glm::normalize(wo + wi);
    const double m = .05 + .9 * unit(engine), my = .05 + .9 * unit(engine), nu = 1 + 200 * unit(engine), nv = 1 + 200 * unit(engine);
    const double c = wh.z, theta = std::acos(c), tan2 = std::pow(std::tan(theta), 2), cos2phi = wh.x * wh.x / (1 - c * c), o = wo.z, in = wi.z;
    const auto check = [&](int kind, double x, double y, double expected) {
      const double got = modelTimesCosine(reflectanceModel(kind, x, y), wo, wi);
      EXPECT_NEAR(got, expected, 1e-6 * expected + 1e-12) << "model " << kind << ' ' << x << ' ' << y;
    };
    const double groove = std::min({1.0, 2 * c * o / dot(wo, wh), 2 * c * in / dot(wo, wh)});
    check(kCookTorrance, m, m, groove * std::exp(-theta * theta / (m * m)) / (4 * kPi * m * m * o));
    check(kBlinnPhong, nu, nu, (nu + 2) * (nu + 4) / (8 * kPi * (std::pow(2, -nu / 2) + nu)) * std::pow(c, nu) * in);
    check(kWard, m, my, std::exp(-tan2 * (cos2phi / (m * m) + (1 - cos2phi) / (my * my))) / (4 * kPi * m * my) * std::sqrt(in / o));
    check(kAshikhminShirley, nu, nv, std::sqrt((nu + 1) * (nv + 1)) * std::pow(c, nu * cos2phi + nv * (1 - cos2phi)) / (8 * kPi * dot(wi, wh) * std::max(in, o)) * in);
    check(kGgx, m, my, ggxDistributionAnisotropic(wh, m, my) * ggxVisibilityAnisotropic(wo, wi, m, my) * in);
    const auto lambda = [&](double cosine) {
      const double a = cosine / (m * std::sqrt(1 - cosine * cosine));
      return std::exp(-a * a) / (2 * a * std::sqrt(kPi)) - std::erfc(a) / 2;
    };
    check(kBeckmann, m, m, std::exp(-tan2 / (m * m)) / (kPi * m * m * std::pow(c, 4)) / (1 + lambda(o) + lambda(in)) / (4 * o));
  }
}

// Normals project to the surface that they came from: the integral of D cos is 1, D = ndf / (pi x y) where D is a distribution of area.
TEST(Models, DistributionsIntegrateToOne) {
  for (int kind : {kBeckmann, kGgx})
    for (const auto& [x, y] : {std::pair{.01, .01}, {.2, .2}, {1.0, 1.0}, {.1, .4}, {.9, .05}}) {
      const auto m = reflectanceModel(kind, x, y);
      const double total = overHalfVectors(x, y, [&](const Vec3& wh) { return ndfValue(m, wh) * wh.z; }) / (kPi * x * y);
      EXPECT_NEAR(total, 1.0, 2e-4) << kind << ' ' << x << ' ' << y;
    }
}

// 1 + Lambda(wo) is the area of microfacets seen from wo over that of the surface, whatever the distribution.
TEST(Models, BeckmannMaskingBelongsToItsDistribution) {
  for (const auto& [x, y] : {std::pair{.2, .2}, {.9, .9}, {.1, .5}})
    for (double theta : {.3, 1.0, 1.4}) {
      const Vec3 wo = polar(theta, .7);
      const auto m = reflectanceModel(kBeckmann, x, y);
      const double seen = overHalfVectors(x, y, [&](const Vec3& wh) { return ndfValue(m, wh) * std::max(dot(wo, wh), 0.0); }) / (kPi * x * y);
      EXPECT_NEAR(wo.z + beckmannLambdaTimesCosine(wo, x, y), seen, 2e-3 * seen) << x << ' ' << theta;
    }
}

TEST(Models, PublishedAlbedos) {
  for (const auto& [alpha, expected] : {std::pair{.05, .993}, {.1, .971}, {.2, .895}, {.4, .687}})
    EXPECT_NEAR(albedo(reflectanceModel(kWard, alpha, alpha), Vec3(0, 0, 1)), expected, 1e-3) << alpha;
  for (double n : {1.0, 10.0, 100.0, 1e4}) EXPECT_NEAR(albedo(reflectanceModel(kBlinnPhong, n, n), Vec3(0, 0, 1)), 1.0, 3e-3) << n;
}

// White furnace: what a model gives back of uniform light.
TEST(Models, AlbedoStaysBelowOne) {
  for (int kind : {kBeckmann, kBlinnPhong, kGgx, kAshikhminShirley})
    for (double width : {.02, .3, 1.0})
      for (double theta : {0.0, .8, 1.3, 1.55}) {
        const double x = modelHasExponent(kind) ? 2 / (width * width) - 1 : width;
        const double a = albedo(reflectanceModel(kind, x, x), polar(theta, 0));
        EXPECT_LE(a, 1.003) << kind << ' ' << width << ' ' << theta;
        EXPECT_GT(a, 0.0);
      }
}

// ALGORITHMS 2.2, relative L2 over the hemisphere.
TEST(Mixtures, OneLobeHasThePublishedErrors) {
  const auto error = [](int kind, double width, const Vec2& lobe) {
    const auto m = reflectanceModel(kind, width, width);
    const double w = modelHasExponent(kind) ? std::sqrt(2 / (width + 1)) : width;
    const auto over = [&](auto f) { return quadrature::integrate([&](double logU) { const double u = std::exp(logU); return u * f(u); }, std::log(1e-9 * w * w), 0.0, 40); };
    const auto truth = [&](double u) { return ndfValue(m, Vec3(std::sqrt(u * (2 - u)), 0, 1 - u)); };
    const double difference2 = over([&](double u) { return std::pow(truth(u) - lobe.x * std::exp(-lobe.y * u), 2); });
    const double norm2 = over([&](double u) { return std::pow(truth(u), 2); });
    return std::sqrt(difference2 / norm2);
  };
  for (double m : {.05, .1, .2}) {
    EXPECT_NEAR(error(kCookTorrance, m, ndfPaperLobe(kCookTorrance, m)) / (.103 * m * m), 1.0, .1) << m;
    EXPECT_NEAR(error(kCookTorrance, m, ndfBestLobe(kCookTorrance, m)) / (.042 * m * m), 1.0, .1) << m;
    EXPECT_NEAR(error(kWard, m, ndfPaperLobe(kWard, m)) / (.90 * m * m), 1.0, .1) << m;
    EXPECT_NEAR(error(kWard, m, ndfBestLobe(kWard, m)) / (.37 * m * m), 1.0, .12) << m;
    EXPECT_NEAR(error(kBeckmann, m, ndfPaperLobe(kBeckmann, m)) / (.77 * m * m), 1.0, .1) << m;
    EXPECT_NEAR(error(kBeckmann, m, ndfBestLobe(kBeckmann, m)) / (.39 * m * m), 1.0, .12) << m;
  }
  for (double n : {10.0, 100.0, 1000.0}) {
    EXPECT_NEAR(error(kBlinnPhong, n, ndfPaperLobe(kBlinnPhong, n)) / (.61 / n), 1.0, .1) << n;
    EXPECT_NEAR(error(kBlinnPhong, n, ndfBestLobe(kBlinnPhong, n)) / (.25 / n), 1.0, .1) << n;
  }
}

struct StringError {
  double squared, energy;
};

/// A string of lobes against the Ashikhmin-Shirley distribution.
template <class Rule>
StringError stringError(double nu, double nv, int count, Rule rule) {
  const auto m = reflectanceModel(kAshikhminShirley, nu, nv);
  const auto mixture = [&](const Vec3& wh) {
    double sum = 0;
    for (int k = 0; k < count; ++k) {
      const StringLobe lobe = rule(nu, nv, count, k);
      sum += sgEvaluate(sphericalGaussian(Vec3(0, std::sin(lobe.angle), std::cos(lobe.angle)), lobe.sharpness, lobe.amplitude), wh);
    }
    return sum;
  };
  const double wx = std::sqrt(2 / nu), wy = std::sqrt(2 / nv);
  const double norm2 = overHalfVectors(wx, wy, [&](const Vec3& wh) { return std::pow(ndfValue(m, wh), 2); });
  const double error2 = overHalfVectors(wx, wy, [&](const Vec3& wh) { return std::pow(mixture(wh) - ndfValue(m, wh), 2); });
  return {error2 / norm2, overHalfVectors(wx, wy, mixture) / overHalfVectors(wx, wy, [&](const Vec3& wh) { return ndfValue(m, wh); })};
}

// ALGORITHMS 2.5: the paper's rule makes too much energy, ours does not.
TEST(Mixtures, StringsOfElongatedLobes) {
  struct Row {
    double nu, nv, paper, paperEnergy, oursAtMost;
    int count;
  };
  for (const Row& row : {Row{50, 25, .237, 1.56, 6e-4, 3}, Row{100, 25, .445, 1.69, 5e-4, 5}, Row{100, 10, .252, 1.49, 1.2e-3, 7}, Row{200, 10, .121, 1.33, 3e-3, 9},
                         Row{1e4, 100, .085, 1.24, 3.3e-3, 21}}) {
    EXPECT_EQ(stringLobeCount(row.nu, row.nv), row.count);
    const StringError paper = stringError(row.nu, row.nv, row.count, paperStringLobe), ours = stringError(row.nu, row.nv, row.count, ndfStringLobe);
    std::printf("string %g/%g with %d lobes: squared error %.2e (energy %.2f), the paper's %.2e (%.2f)\n", row.nu, row.nv, row.count, ours.squared, ours.energy,
                paper.squared, paper.energy);
    EXPECT_NEAR(paper.squared / row.paper, 1.0, .1);
    EXPECT_NEAR(paper.energy, row.paperEnergy, .03);
    EXPECT_LE(ours.squared, row.oursAtMost);
    EXPECT_NEAR(ours.energy, .98, .04);
  }
}

/// One million random models, parameters at their ends and directions anywhere: finite and never negative, under light of 1e-6 to 1e6.
template <class Model, class Vector, class Make, class Evaluate>
void expectSaneAtExtremes(Make make, Evaluate evaluate) {
  using Real = decltype(Vector{}.x);
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> gauss;
  const auto direction = [&] {
    glm::dvec3 d(gauss(engine), gauss(engine), gauss(engine));
    const double kind = unit(engine);
    if (kind < .2) d.z *= std::pow(10.0, -8 * unit(engine));                       // grazing, either side
    else if (kind < .4) d = glm::dvec3(d.x * 1e-4 * unit(engine), d.y * 1e-4, 1);  // along the normal
    else if (kind < .45) d = glm::dvec3(0, 0, d.z < 0 ? -1 : 1);
    else if (kind < .5) d = glm::dvec3(d.x < 0 ? -1 : 1, 0, 0);
    d = glm::normalize(d);
    return Vector(Real(d.x), Real(d.y), Real(d.z));
  };
  const auto parameter = [&](bool exponent) {
    const double kind = unit(engine);
    if (kind < .15) return Real(exponent ? 1.0 : 1e-4);
    if (kind < .3) return Real(exponent ? 1e6 : 1.0);
    return Real(exponent ? std::pow(10.0, 6 * unit(engine)) : std::pow(10.0, -4 * unit(engine)));
  };
  int bad = 0, lit = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const int kind = i % kModelCount;
    const bool exponent = modelHasExponent(kind);
    const Model m = make(kind, parameter(exponent), parameter(exponent));
    const Vector wo = direction();
    Vector wi = direction();
    if (unit(engine) < .5) wi = Vector(-wo.x, -wo.y, wo.z);  // the peak
    const Vector f0(unit(engine) < .5 ? Real(0) : Real(1), Real(unit(engine)), Real(1));
    const Vector value = evaluate(m, f0, wo, wi);
    for (int c = 0; c < 3; ++c) {
      if (!(std::isfinite(Real(1e6) * value[c]) && Real(1e-6) * value[c] >= 0) && bad++ < 5)
        ADD_FAILURE() << "model " << kind << ' ' << m.x << ' ' << m.y << " wo " << wo.x << ' ' << wo.y << ' ' << wo.z << " wi " << wi.x << ' ' << wi.y << ' ' << wi.z
                      << " value " << value[c];
      if ((wo.z <= 0 || wi.z <= 0) && value[c] != 0 && bad++ < 5) ADD_FAILURE() << "light through the surface";
    }
    lit += value.z > 0;
  }
  EXPECT_EQ(bad, 0);
  EXPECT_GT(lit, 200'000);
}

TEST(Models, RoughReflectionPassesOverSmoothly) {
  for (int kind = 0; kind < kModelCount; ++kind) {
    const double from = kind == kGgx ? .45 : .5, to = from + .15;
    EXPECT_EQ(roughReflectionShare(kind, from * from * .999), 0.0);
    EXPECT_NEAR(roughReflectionShare(kind, .25 * (from + to) * (from + to)), .5, 1e-12);
    EXPECT_EQ(roughReflectionShare(kind, to * to * 1.001), 1.0);
    // No edge at either end, and never back: the derivative by the root of alpha is that of 3 t^2 - 2 t^3.
    for (double t = 0.0; t <= 1.0; t += .125) {
      const double h = 1e-5, at = from + .15 * t;
      const double slope = (roughReflectionShare(kind, (at + h) * (at + h)) - roughReflectionShare(kind, (at - h) * (at - h))) / (2 * h);
      EXPECT_NEAR(slope * .15, 6.0 * t * (1.0 - t), 1e-3) << kind << ' ' << t;
    }
  }
}

TEST(Models, AMillionExtremesInDouble) {
  expectSaneAtExtremes<ReflectanceModel, Vec3>([](int kind, double x, double y) { return reflectanceModel(kind, x, y); },
                                               [](const ReflectanceModel& m, const Vec3& f0, const Vec3& wo, const Vec3& wi) { return reflectanceTimesCosine(m, f0, wo, wi); });
}
TEST(Models, AMillionExtremesInFloat) {
  expectSaneAtExtremes<lobe32::ReflectanceModel, lobe32::Vec3>(
      [](int kind, float x, float y) { return lobe32::reflectanceModel(kind, x, y); },
      [](const lobe32::ReflectanceModel& m, const lobe32::Vec3& f0, const lobe32::Vec3& wo, const lobe32::Vec3& wi) { return lobe32::reflectanceTimesCosine(m, f0, wo, wi); });
}

}  // namespace
}  // namespace chiaro
