/// GGX and the mixtures that stand in for it, double C++ against quadrature and the textbook definitions.

#include <gtest/gtest.h>

#include "shaders/cpp/lobe.h"
#include "tests/lobe/quadrature.h"

namespace chiaro {
namespace {

using namespace lobe64;

// A distribution of normals projects to the surface it came from: integral of D cos over the hemisphere is 1.
TEST(Ggx, DistributionsIntegrateToOne) {
  for (double alpha : {.01, .1, .4, 1.0}) {
    // In slopes tan^2 = t: half of it lies within alpha, so integrate over log t.
    const double total = quadrature::integrate(
        [&](double logT) {
          const double t = std::exp(logT), c = 1 / std::sqrt(1 + t);
          return quadrature::kPi * ggxDistribution(c, alpha) * std::pow(c, 4) * t;  // dw cos = pi c^4 dt; dt = t dlog t
        },
        std::log(1e-14), std::log(1e14), 60);
    EXPECT_NEAR(total, 1.0, 1e-6) << alpha;
  }
  for (const auto& [ax, ay] : {std::pair{.1, .4}, {.5, .5}, {1.0, .2}}) {
    double total = 0;
    const int azimuths = 400;
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * quadrature::kPi * k / azimuths;
      total += quadrature::integrate(
          [&, ax = ax, ay = ay](double logT) {
            const double t = std::exp(logT), c = 1 / std::sqrt(1 + t), s = std::sqrt(t) * c;
            return 0.5 * ggxDistributionAnisotropic(Vec3(s * std::cos(phi), s * std::sin(phi), c), ax, ay) * std::pow(c, 4) * t;
          },
          std::log(1e-12), std::log(1e12), 30);
    }
    EXPECT_NEAR(total * 2 * quadrature::kPi / azimuths, 1.0, 1e-6);
  }
}

TEST(Ggx, IsotropicFormsAgree) {
  for (double alpha : {.003, .1, .7, 1.0}) {
    for (double c = 0.01; c < 1; c += 0.037) {
      const Vec3 h(std::sqrt(1 - c * c), 0, c);
      EXPECT_NEAR(ggxDistributionAnisotropic(h, alpha, alpha) / ggxDistribution(c, alpha), 1.0, 1e-10);
      const double textbook = alpha * alpha / (quadrature::kPi * std::pow(c * c * (alpha * alpha - 1) + 1, 2));
      EXPECT_NEAR(ggxDistribution(c, alpha) / textbook, 1.0, 1e-9);
    }
  }
}

// V = G / (4 no ni), G = 1 / (1 + L(o) + L(i)), L = (sqrt(1 + alpha^2 tan^2) - 1) / 2.
TEST(Ggx, VisibilityIsHeightCorrelatedSmith) {
  for (double alpha : {.01, .3, 1.0}) {
    for (double o : {.05, .4, 1.0}) {
      for (double i : {.02, .7, 1.0}) {
        const auto lambda = [&](double c) { return .5 * (std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1); };
        const double expected = 1 / (1 + lambda(o) + lambda(i)) / (4 * o * i);
        EXPECT_NEAR(ggxVisibility(o, i, alpha) / expected, 1.0, 1e-12);
        EXPECT_NEAR(ggxVisibility(i, o, alpha), ggxVisibility(o, i, alpha), 1e-12 * expected);
        const Vec3 wo(std::sqrt(1 - o * o), 0, o), wi(0, std::sqrt(1 - i * i), i);
        EXPECT_NEAR(ggxVisibilityAnisotropic(wo, wi, alpha, alpha) / expected, 1.0, 1e-12);
      }
    }
  }
}

TEST(Ggx, Schlick) {
  EXPECT_EQ(fresnelSchlick(Vec3(.04, .5, 1), 1.0), Vec3(.04, .5, 1));
  EXPECT_EQ(fresnelSchlick(Vec3(.04, .5, 1), 0.0), Vec3(1, 1, 1));
  EXPECT_NEAR(fresnelSchlick(Vec3(.04), .5).x, .04 + .96 / 32, 1e-15);
}

// ALGORITHMS 2.2 (A): relative L2 error of the mixture of exponentials in y, on [0, infinity). As y = tan^2-like, dw ~ dy.
TEST(GgxMixture, TermsFitTheProfile) {
  const double expected[4] = {.140, .042, .014, .0053};
  for (int count = 1; count <= 4; ++count) {
    const auto difference = [&](double y) {
      double sum = -std::pow(1 + y, -2);
      for (int j = 0; j < count; ++j) {
        const Vec2 term = ggxMixtureTerm(count, j);
        sum += term.x * std::exp(-term.y * y);
      }
      return sum;
    };
    const double error2 = quadrature::integrate([&](double u) { return std::pow(difference(u / (1 - u)), 2) / ((1 - u) * (1 - u)); }, 0, 1 - 1e-9, 40);
    EXPECT_NEAR(std::sqrt(error2 * 3), expected[count - 1], .05 * expected[count - 1]) << count;  // integral of (1+y)^-4 is 1/3
  }
}

// ALGORITHMS 2.2 (B): the worst over alpha of the SG mixtures, relative L2 on the hemisphere.
TEST(GgxMixture, LobesFitTheDistribution) {
  const double worst[4] = {.201, .056, .017, .0083};
  for (int count = 1; count <= 4; ++count) {
    double largest = 0;
    for (double alpha = .01; alpha < .9905; alpha += .01) {
      const auto exact = [&](double c) { return ggxDistribution(c, alpha) * quadrature::kPi * alpha * alpha; };
      const auto mixture = [&](double c) {
        double sum = 0;
        for (int j = 0; j < count; ++j) {
          const Vec2 lobe = ggxMixtureLobe(alpha, count, j);
          sum += lobe.x * std::exp(lobe.y * (c - 1));
        }
        return sum;
      };
      // 1 - c on a log scale: the peak is alpha^2 wide.
      const auto over = [&](auto f) {
        return quadrature::integrate([&](double logU) { const double u = std::exp(logU); return u * f(1 - u); }, std::log(1e-12), 0.0, 30);
      };
      const double error = std::sqrt(over([&](double c) { return std::pow(mixture(c) - exact(c), 2); }) / over([&](double c) { return std::pow(exact(c), 2); }));
      largest = error <= largest ? largest : error;
    }
    std::printf("GGX as %d lobes: worst relative L2 error over alpha %.4f\n", count, largest);
    EXPECT_NEAR(largest, worst[count - 1], .05 * worst[count - 1]) << count;
  }
}

TEST(GgxMixture, PublishedExample) {
  const double amplitudes[3] = {.7117, .2468, .0134};
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(ggxMixtureLobe(.1, 3, j).x, amplitudes[j], 5e-4);  // the polynomials' coefficients were rounded
  // Mirror-like: the sharpness is capped.
  EXPECT_EQ(ggxMixtureLobe(1e-4, 1, 0).y, 1e6);
  EXPECT_EQ(ggxMixtureLobe(1.0, 3, 1), ggxMixtureLobe(.99, 3, 1));
}

// Estevez and Kulla's distribution holds all microfacets: its projected area is 1.
// Against a plain sum over half vectors' slopes; the limit is what the header of the function says.
TEST(Ggx, AnisotropicAlbedo) {
  double worst = 0.0, worstFresnel = 0.0;
  for (const auto& [ax, ay] : {std::pair{0.4, 0.09}, {0.09, 0.4}, {1.0, 0.3}, {1.0, 0.02}, {0.5, 0.25}, {0.02, 0.01}, {0.3, 0.3}})
    for (double z : {1.0, 0.8, 0.5, 0.25, 0.1})
      for (double turn : {0.0, 0.7, 1.5}) {
        const double s = std::sqrt(1.0 - z * z);
        const Vec3 wo(s * std::cos(turn), s * std::sin(turn), z);
        double albedo = 0.0, fresnel = 0.0;
        constexpr int kRadii = 120, kTurns = 120;
        for (int i = 0; i < kRadii; ++i)
          for (int j = 0; j < kTurns; ++j) {
            const double u = (i + 0.5) / kRadii, r = 0.7 * u / (1.0 - u), phi = (j + 0.5) / kTurns * kTwoPi;
            const double x = ax * r * std::cos(phi), y = ay * r * std::sin(phi), hz = 1.0 / std::sqrt(1.0 + x * x + y * y);
            const Vec3 wh(x * hz, y * hz, hz);
            const double c = glm::dot(wo, wh);
            const Vec3 wi = 2.0 * c * wh - wo;
            if (!(c > 0.0 && wi.z > 0.0)) continue;
            const double solidAngle = 4.0 * c * ax * ay * r * hz * hz * hz * 0.7 / ((1.0 - u) * (1.0 - u)) / kRadii * kTwoPi / kTurns;
            const double reflected = ggxDistributionAnisotropic(wh, ax, ay) * ggxVisibilityAnisotropic(wo, wi, ax, ay) * wi.z * solidAngle;
            albedo += reflected;
            fresnel += reflected * std::pow(1.0 - c, 5);
          }
        const auto ours = ggxAlbedoAnisotropic(wo, ax, ay);
        worst = std::max(worst, std::abs(ours.x + ours.y - albedo));
        worstFresnel = std::max(worstFresnel, std::abs(ours.y - fresnel));
      }
  std::printf("anisotropic albedo off by at most %.4f, its Fresnel part by %.4f\n", worst, worstFresnel);
  EXPECT_LE(worst, 0.027);
  EXPECT_LE(worstFresnel, 0.016);
}

TEST(Sheen, DistributionIsNormalised) {
  for (const double alpha : {0.0049, 0.05, 0.3, 1.0}) {
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      sum += lobe64::sheenDistribution(cosine, alpha) * cosine * lobe64::kTwoPi / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << alpha;
  }
}

// The reflectance against the formula written out with the published coefficients.
TEST(Sheen, MatchesThePublishedFit) {
  const auto lambda = [](double r, double x) {
    const double t = (1 - r) * (1 - r);
    const double p[5] = {t * 25.3245 + (1 - t) * 21.5473, t * 3.32435 + (1 - t) * 3.82987, t * 0.16801 + (1 - t) * 0.19823,
                         t * -1.27393 + (1 - t) * -1.97760, t * -4.85967 + (1 - t) * -4.32054};
    const auto l = [&](double y) { return p[0] / (1 + p[1] * std::pow(y, p[2])) + p[3] * y + p[4]; };
    return x < 0.5 ? std::exp(l(x)) : std::exp(2 * l(0.5) - l(1 - x));
  };
  for (const double alpha : {0.01, 0.2, 0.7, 1.0})
    for (const double o : {0.05, 0.4, 0.9})
      for (const double i : {0.1, 0.6, 0.99})
        for (const double h : {0.1, 0.7, 0.95}) {
          const double d = (2 + 1 / alpha) * std::pow(1 - h * h, 0.5 / alpha) / (2 * lobe64::kPi);
          const double expected = d / ((1 + lambda(alpha, o) + lambda(alpha, i)) * 4 * o * i);
          EXPECT_NEAR(lobe64::sheenReflectance(o, i, h, alpha), expected, 1e-9 + 1e-6 * expected) << alpha << ' ' << o << ' ' << i << ' ' << h;
        }
  EXPECT_EQ(lobe64::sheenReflectance(0.5, -0.1, 0.3, 0.2), 0.0);
  EXPECT_TRUE(std::isnan(lobe64::sheenReflectance(0.5, std::nan(""), 0.3, 0.2)));
}

}  // namespace
}  // namespace chiaro
