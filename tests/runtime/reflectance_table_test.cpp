/// The fitted tables of round reflectance models, as a shader reads them, against the models by quadrature.

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/brdf/albedo_table.h"
#include "runtime/brdf/reflectance_fit.h"
#include "runtime/brdf/reflectance_table.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using namespace lobe64;

struct View {
  double error = 0.0;   ///< squared, relative
  double albedo = 0.0;  ///< the model's, F = 1
  double fresnel = 0.0; ///< the part of it that (1 - wo.wh)^5 weights
};

/// Cosine nodes in both angles of the half vector's slopes: not the fit's own samples.
View measure(int kind, double parameter, double theta, const std::vector<SliceLobe>& lobes) {
  const ReflectanceModel model = reflectanceModel(kind, parameter, parameter);
  const Vec3 wo(std::sin(theta), 0, std::cos(theta));
  const double width = modelWidth(kind, parameter);
  View view;
  double error2 = 0, norm2 = 0;
  for (int i = 0; i < 100; ++i) {
    const double t = (i + 0.5) / 100, r = 0.7 * t / (1 - t) * 2, step = 0.7 * 2 / ((1 - t) * (1 - t)) / 100;
    for (int j = 0; j < 40; ++j) {
      const double phi = (j + 0.25) / 40 * kTwoPi, x = width * r * std::cos(phi), y = width * r * std::sin(phi), z = 1 / std::sqrt(1 + x * x + y * y);
      const Vec3 wh(x * z, y * z, z);
      const double c = dot(wo, wh);
      if (c <= 0) continue;
      const Vec3 wi = 2 * c * wh - wo;
      if (wi.z <= 0) continue;
      const double weight = 4 * c * width * width * r * step * kTwoPi / 40 * z * z * z, truth = modelTimesCosine(model, wo, wi);
      double sum = 0;
      for (const SliceLobe& lobe : lobes) sum += (lobe.weight + lobe.fresnelWeight) * sgEvaluate(sphericalGaussian(lobe.axis, lobe.sharpness, vmfAmplitude(lobe.sharpness)), wi);
      error2 += weight * (sum - truth) * (sum - truth);
      norm2 += weight * truth * truth;
      view.albedo += weight * truth;
      view.fresnel += weight * truth * fresnelSchlickWeight(c);
    }
  }
  view.error = error2 / norm2;
  return view;
}

TEST(ReflectanceTable, ViewSlicesAreClose) {
  for (int kind : {kCookTorrance, kBeckmann, kBlinnPhong, kWard, kGgx}) {
    const ReflectanceTable& table = reflectanceTableOf(kind);
    double worst = 0, worstAlbedo = 0, worstFresnel = 0;
    // Where neighbours of the table shared out their work differently, what lies between them is off: a few places do not show it.
    for (double width : {.02, .0617, .13, .28, .37, .55, .65, .8, .88, .95}) {
      const double parameter = modelHasExponent(kind) ? 2 / (width * width) - 1 : width;
      for (double degrees = 0.0; degrees < 75.0; degrees += 5.3) {
        const double theta = degrees / 180 * kPi;
        const auto lobes = reflectanceLobes(table, width, std::cos(theta));
        ASSERT_EQ(lobes.size(), static_cast<std::size_t>(reflectanceLobeCount(kind)));
        double weight = 0, fresnel = 0;
        for (const SliceLobe& lobe : lobes) {
          EXPECT_NEAR(glm::length(lobe.axis), 1.0, 1e-9);
          EXPECT_GE(lobe.weight, 0.0);
          EXPECT_GE(lobe.fresnelWeight, 0.0);
          weight += lobe.weight;
          fresnel += lobe.fresnelWeight;
        }
        const View view = measure(kind, parameter, theta, lobes);
        EXPECT_LE(view.error, width <= .4 ? .015 : .022) << kind << ' ' << width << ' ' << degrees;
        worst = std::max(worst, view.error);
        worstAlbedo = std::max(worstAlbedo, std::abs(weight + fresnel - view.albedo));
        worstFresnel = std::max(worstFresnel, std::abs(fresnel - view.fresnel));
      }
    }
    std::printf("model %d: worst view %.4f, albedo off by at most %.3f, its Fresnel part by %.3f\n", kind, worst, worstAlbedo, worstFresnel);
    EXPECT_LE(worstAlbedo, .01) << kind;
    EXPECT_LE(worstFresnel, .01) << kind;
  }
}

// What keeps a uniform environment uniform: GGX's weights sum to its albedo. (Where Fresnel adds less than 2e-4 the fit may leave it out.)
TEST(ReflectanceTable, GgxWeightsSumToItsAlbedo) {
  const ReflectanceTable& table = reflectanceTableOf(kGgx);
  for (int j = 0; j < table.cosineCount; ++j)
    for (int i = 0; i < table.widthCount; ++i) {
      const double cosine = std::max(std::pow(j / (table.cosineCount - 1.0), 2), .03);
      const double width = std::pow(.1 + .9 * i / (table.widthCount - 1.0), 2);
      glm::dvec2 sum(0.0);
      for (const SliceLobe& lobe : reflectanceLobes(table, width, std::pow(j / (table.cosineCount - 1.0), 2))) sum += glm::dvec2(lobe.weight, lobe.fresnelWeight);
      const glm::dvec2 albedo = ggxAlbedo(width, cosine);
      EXPECT_LE(std::abs(sum.x - albedo.x), 2e-4) << width << ' ' << cosine;
      EXPECT_LE(std::abs(sum.y - albedo.y), 2e-4) << width << ' ' << cosine;
    }
}

// Tails count under light whose range is a thousand to one: the mean of |log| of fitted over true where the slice is above 1e-3 of its peak.
TEST(ReflectanceTable, GgxFollowsItsTail) {
  const ReflectanceTable& table = reflectanceTableOf(kGgx);
  for (double width : {.04, .09, .16})
    for (double degrees : {10.0, 45.0, 65.0}) {
      const double theta = degrees / 180 * kPi;
      const Vec3 wo(std::sin(theta), 0, std::cos(theta));
      const ReflectanceModel model = reflectanceModel(kGgx, width, width);
      const auto lobes = reflectanceLobes(table, width, wo.z);
      std::vector<std::pair<double, double>> pairs;
      double peak = 0;
      for (int a = 0; a < 80; ++a)
        for (int b = 0; b < 160; ++b) {
          const double z = (a + .5) / 80, phi = (b + .5) / 160 * kTwoPi, s = std::sqrt(1 - z * z);
          const Vec3 wi(s * std::cos(phi), s * std::sin(phi), z);
          double fitted = 0;
          for (const SliceLobe& lobe : lobes)
            fitted += (lobe.weight + lobe.fresnelWeight) * sgEvaluate(sphericalGaussian(lobe.axis, lobe.sharpness, vmfAmplitude(lobe.sharpness)), wi);
          pairs.emplace_back(modelTimesCosine(model, wo, wi), fitted);
          peak = std::max(peak, pairs.back().first);
        }
      double sum = 0;
      int count = 0;
      for (const auto& [truth, fitted] : pairs)
        if (truth > 1e-3 * peak) sum += std::abs(std::log(std::max(fitted, 1e-9 * peak) / truth)), ++count;
      std::printf("alpha %.2f, %2.0f degrees: mean |log| %.3f of %d\n", width, degrees, sum / count, count);
      EXPECT_LE(sum / count, .2) << width << ' ' << degrees;
    }
}

TEST(ReflectanceTable, ThreadsDoNotMatter) {
  EXPECT_EQ(makeReflectanceTable(kWard, 5, 7, 1).entries, makeReflectanceTable(kWard, 5, 7, 2).entries);
}

// Below the table's narrowest width a slice only scales; at grazing views it stays finite.
TEST(ReflectanceTable, ExtremesAreFinite) {
  const ReflectanceTable& table = reflectanceTableOf(kGgx);
  for (double width : {1e-4, .01, 1.0})
    for (double cosine : {1e-6, .5, 1.0})
      for (const SliceLobe& lobe : reflectanceLobes(table, width, cosine)) {
        EXPECT_TRUE(std::isfinite(lobe.sharpness) && lobe.sharpness > 0);
        EXPECT_NEAR(glm::length(lobe.axis), 1.0, 1e-9);
        EXPECT_TRUE(lobe.weight >= 0 && lobe.fresnelWeight >= 0 && lobe.weight + lobe.fresnelWeight < 3) << lobe.weight << ' ' << lobe.fresnelWeight;
      }
}

}  // namespace
}  // namespace chiaro
