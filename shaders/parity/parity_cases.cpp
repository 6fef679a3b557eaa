#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "shaders/parity/parity.h"

namespace chiaro::parity {
namespace {

constexpr std::size_t kSamples = 65536;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kDenormal = 1e-40f;

/// Inputs of every kind the promise names. One generator per case, seeded by the case's name.
class Generator {
 public:
  explicit Generator(const std::string& name) {
    std::seed_seq seed(name.begin(), name.end());
    engine_.seed(seed);
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double logUniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double p) { return uniform(0, 1) < p; }
  template <class T>
  T pick(std::initializer_list<T> values) {
    return *(values.begin() + static_cast<std::ptrdiff_t>(uniform(0, static_cast<double>(values.size()) * (1 - 1e-12))));
  }

  /// Mostly log-spaced 1e-6..1e6; some of 0, denormal, tiny, huge, +-inf, NaN, negative.
  float sharpness() {
    if (chance(0.02)) return pick({kNan, kInfinity, -kInfinity, -1.0f});
    if (chance(0.06)) return pick({0.0f, -0.0f, kDenormal, 1e-30f, 1e-20f, 1e6f, 1e10f, 1e25f, 3e38f});
    if (chance(0.1)) return static_cast<float>(logUniform(1e-30, 1e30));
    return static_cast<float>(logUniform(1e-6, 1e6));
  }
  float amplitude() {
    if (chance(0.02)) return pick({kNan, kInfinity, -kInfinity});
    if (chance(0.05)) return pick({0.0f, kDenormal, 1e-20f, 1e15f, -1e15f});
    return static_cast<float>((chance(0.1) ? -1 : 1) * logUniform(1e-3, 1e3));
  }
  glm::dvec3 direction() {
    if (chance(0.05)) {
      const double s = chance(0.5) ? 1 : -1;
      return pick({glm::dvec3(s, 0, 0), glm::dvec3(0, s, 0), glm::dvec3(0, 0, s)});
    }
    std::normal_distribution<double> gauss;
    return glm::normalize(glm::dvec3(gauss(engine_), gauss(engine_), gauss(engine_)));
  }
  /// At `angle` from `axis`, any azimuth.
  glm::dvec3 tilted(glm::dvec3 axis, double angle) {
    const glm::dvec3 other = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 third = glm::cross(axis, other);
    const double phi = uniform(0, 2 * 3.14159265358979);
    return std::cos(angle) * axis + std::sin(angle) * (std::cos(phi) * other + std::sin(phi) * third);
  }
  /// Related to `axis` as lobes meet: equal, opposite, nearly so, at an angle where a lobe of this sharpness still counts, any.
  glm::vec3 partner(glm::vec3 axis, double sharpness) {
    const glm::dvec3 a(axis);
    const double kind = uniform(0, 1);
    if (kind < 0.05) return axis;
    if (kind < 0.10) return -axis;
    if (kind < 0.15) return glm::vec3(tilted(a, logUniform(1e-8, 1)));
    if (kind < 0.20) return glm::vec3(tilted(-a, logUniform(1e-8, 1)));
    if (kind < 0.70 && sharpness > 0 && std::isfinite(sharpness)) {
      return glm::vec3(tilted(a, 2 * std::asin(std::min(1.0, std::sqrt(uniform(0, 18) / (2 * sharpness))))));
    }
    return glm::vec3(direction());
  }
  /// One component may be replaced by NaN or an infinity.
  glm::vec3 spoil(glm::vec3 v) {
    if (chance(0.005)) v[static_cast<int>(uniform(0, 2.999))] = pick({kNan, kInfinity, -kInfinity});
    return v;
  }
  float spoil(float x) { return chance(0.01) ? pick({kNan, kInfinity, -kInfinity}) : x; }

 private:
  std::mt19937_64 engine_;
};

void push(std::vector<float>& out, glm::vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }

double unitScale(const float*) { return 1.0; }
/// Lobes scale with their amplitudes: the floor does too, upwards.
double amplitudeScale(double product) { return std::max(1.0, std::isfinite(product) ? std::abs(product) : 1.0); }

std::vector<Group> scalars(int count) {
  std::vector<Group> groups;
  for (int i = 0; i < count; ++i) groups.push_back({i, 1});
  return groups;
}

/// Axis as a vector, then sharpness and amplitude, for `count` lobes.
std::vector<Group> lobes(int count) {
  std::vector<Group> groups;
  for (int i = 0; i < count; ++i) groups.insert(groups.end(), {{5 * i, 3}, {5 * i + 3, 1}, {5 * i + 4, 1}});
  return groups;
}

using Fill = std::function<void(Generator&, std::vector<float>&)>;

class Registry {
 public:
  void add(Case c, const Fill& fill) {
    Generator generator(c.name);
    for (std::size_t i = 0; i < kSamples; ++i) fill(generator, c.inputs);
    if (!c.scale) c.scale = unitScale;
    cases.push_back(std::move(c));
  }
  std::vector<Case> cases;
};

#define CHIARO_KERNEL(name) #name
#define CHIARO_RUN(name) lobe32::kernel_##name, lobe64::kernel_##name

Case makeCase(std::string name, void (*run32)(const lobe32::KernelInput&, float (&)[25]), void (*run64)(const lobe64::KernelInput&, double (&)[25]),
              int inputs, int outputs, std::vector<Group> groups, std::string domain, Scale scale = {}) {
  Case c;
  c.name = std::move(name);
  c.run32 = run32;
  c.run64 = run64;
  c.inputCount = inputs;
  c.outputCount = outputs;
  c.groups = std::move(groups);
  c.domain = std::move(domain);
  c.scale = std::move(scale);
  return c;
}

#define CHIARO_CASE(name, ...) makeCase(CHIARO_KERNEL(name), CHIARO_RUN(name), __VA_ARGS__)

void addSpecialFunctions(Registry& r) {
  r.add(CHIARO_CASE(oneMinusExpOver, 1, 1, scalars(1), "x >= 0"), [](Generator& g, auto& out) {
    const float x = g.sharpness();
    out.push_back(x < 0 ? -x : x);
  });
  r.add(CHIARO_CASE(errorFunction, 1, 1, scalars(1), "all x"), [](Generator& g, auto& out) {
    out.push_back(g.spoil(static_cast<float>((g.chance(0.5) ? -1 : 1) * g.logUniform(1e-12, 50))));
  });
  const Fill nonNegative = [](Generator& g, auto& out) {
    const float x = g.chance(0.5) ? static_cast<float>(g.uniform(0, 6)) : std::abs(g.sharpness());
    out.push_back(x);
  };
  r.add(CHIARO_CASE(erfcScaled, 1, 1, scalars(1), "x >= 0"), nonNegative);
  r.add(CHIARO_CASE(erfcIntegralScaled, 1, 1, scalars(1), "x >= 0"), nonNegative);
  r.add(CHIARO_CASE(sinPi, 1, 1, scalars(1), "|x| <= 1"), [](Generator& g, auto& out) {
    const double sign = g.chance(0.5) ? -1 : 1;
    const double near = g.logUniform(1e-12, 1);
    out.push_back(static_cast<float>(sign * (g.chance(0.5) ? near : 1 - near)));
  });
  r.add(CHIARO_CASE(atanQuadrant, 2, 1, scalars(1), "x, y >= 0, 1e-30..1e30 or 0"), [](Generator& g, auto& out) {
    for (int i = 0; i < 2; ++i) out.push_back(g.chance(0.02) ? g.pick({0.0f, kNan}) : static_cast<float>(g.chance(0.8) ? g.logUniform(1e-3, 1e3) : g.logUniform(1e-15, 1e15)));
  });
}

void addSphericalGaussians(Registry& r) {
  const Scale oneAmplitude = [](const float* in) { return amplitudeScale(in[4]); };
  const Scale twoAmplitudes = [](const float* in) { return amplitudeScale(static_cast<double>(in[4]) * in[9]); };
  const Fill pair = [](Generator& g, auto& out) {
    const glm::vec3 axis(g.direction());
    const float l1 = g.sharpness();
    const float l2 = g.chance(0.1) ? l1 : g.chance(0.5) ? g.sharpness() : static_cast<float>(l1 * g.logUniform(0.1, 10));
    push(out, g.spoil(axis));
    out.push_back(l1);
    out.push_back(g.amplitude());
    push(out, g.spoil(g.partner(axis, static_cast<double>(l1) * l2 / (static_cast<double>(l1) + l2))));
    out.push_back(l2);
    out.push_back(g.amplitude());
  };
  r.add(CHIARO_CASE(sgEvaluate, 8, 1, scalars(1), "unit axes, sharpness >= 0", oneAmplitude), [](Generator& g, auto& out) {
    const glm::vec3 axis(g.direction());
    const float l = g.sharpness();
    push(out, g.spoil(axis));
    out.push_back(l);
    out.push_back(g.amplitude());
    push(out, g.spoil(g.partner(axis, l)));
  });
  const Fill lobe = [](Generator& g, auto& out) {
    out.push_back(g.sharpness());
    out.push_back(g.amplitude());
  };
  r.add(CHIARO_CASE(sgIntegral, 2, 1, scalars(1), "sharpness >= 0"), lobe);
  r.add(CHIARO_CASE(sgNorm, 2, 1, scalars(1), "sharpness >= 0"), lobe);
  r.add(CHIARO_CASE(sgProduct, 10, 5, lobes(1), "unit axes, sharpness >= 0", twoAmplitudes), pair);
  r.add(CHIARO_CASE(sgInnerProduct, 10, 1, scalars(1), "unit axes, sharpness >= 0", twoAmplitudes), pair);
  r.add(CHIARO_CASE(sgNormalizedInnerProduct, 10, 1, scalars(1), "unit axes, sharpness >= 0"), pair);
  // Nearness divides the distance, and the error that near axes leave in it, by kNearDistance.
  Case likeness = CHIARO_CASE(lobeLikeness, 10, 4, scalars(4), "unit axes, sharpness >= 0");
  likeness.tolerance = 3e-5;
  r.add(likeness, pair);
  const Fill sharpnessOnly = [](Generator& g, auto& out) { out.push_back(g.sharpness()); };
  r.add(CHIARO_CASE(vmfAmplitude, 1, 1, scalars(1), "sharpness >= 0"), sharpnessOnly);
  r.add(CHIARO_CASE(vmfMeanCosine, 1, 1, scalars(1), "sharpness >= 0"), sharpnessOnly);
  r.add(CHIARO_CASE(oneMinusMeanCosine, 1, 1, scalars(1), "sharpness >= 0"), sharpnessOnly);
  r.add(CHIARO_CASE(vmfSharpnessFromMeanCosine, 1, 1, scalars(1), "mean cosine in [0, 1]"), [](Generator& g, auto& out) {
    if (g.chance(0.03)) return out.push_back(g.pick({0.0f, 1.0f, kDenormal, kNan, kInfinity, -kInfinity, 1.5f, -0.5f}));
    const double near = g.logUniform(1e-7, 1);
    out.push_back(static_cast<float>(g.chance(0.5) ? near : 1 - near));
  });
  r.add(CHIARO_CASE(sgConvolve, 4, 2, scalars(2), "sharpness >= 0", [](const float* in) { return amplitudeScale(static_cast<double>(in[1]) * in[3]); }),
        [](Generator& g, auto& out) {
          for (int i = 0; i < 2; ++i) {
            out.push_back(g.sharpness());
            out.push_back(g.amplitude());
          }
        });
}

void addHalfSpaceAndCosine(Registry& r) {
  // Distances where the fraction is neither 0 nor 1, and all others.
  const auto distance = [](Generator& g, float l) {
    if (g.chance(0.03)) return g.pick({0.0f, 1.0f, -1.0f, kDenormal, 2.0f, -2.0f, kNan, kInfinity, -kInfinity});
    const double width = std::isfinite(l) && l > 0 ? std::min(1.0, 1 / std::sqrt(static_cast<double>(l))) : 1.0;
    if (g.chance(0.1)) return static_cast<float>((g.chance(0.5) ? -1 : 1) * (1 - g.logUniform(1e-7, 1)));
    return static_cast<float>(g.chance(0.6) ? std::clamp(g.uniform(-6, 6) * width, -1.0, 1.0) : g.uniform(-1, 1));
  };
  const Fill sineAndSharpness = [distance](Generator& g, auto& out) {
    const float l = g.chance(0.4) ? static_cast<float>(g.logUniform(0.1, 100)) : g.sharpness();
    out.push_back(distance(g, l));
    out.push_back(l);
  };
  r.add(CHIARO_CASE(sgHalfSpaceFraction, 2, 1, scalars(1), "sine in [-1, 1], sharpness >= 0"), sineAndSharpness);
  r.add(CHIARO_CASE(sgHalfSpaceIntegral, 2, 1, scalars(1), "sine in [-1, 1], sharpness >= 0"), sineAndSharpness);
  r.add(CHIARO_CASE(ssdfVisibleFraction, 2, 1, scalars(1), "distance in [-pi, pi], sharpness >= 0"), [distance](Generator& g, auto& out) {
    const float l = g.chance(0.4) ? static_cast<float>(g.logUniform(0.1, 100)) : g.sharpness();
    const float s = distance(g, l);
    out.push_back(g.chance(0.1) ? static_cast<float>(g.uniform(-3.1416, 3.1416)) : std::abs(s) <= 1 ? std::asin(s) : s);
    out.push_back(l);
  });
  // 1 - tanh cancels, so that what is relative to the softness is absolute.
  const auto ofSoftness = [](const float* x) { return std::max(1.0, static_cast<double>(x[1]) / kFloor); };
  const auto distanceAndSoftness = [](Generator& g, auto& out) {
    const double softness = g.chance(0.05) ? 0.0 : g.logUniform(0.01, 1.0);
    out.push_back(static_cast<float>(g.chance(0.5) ? g.uniform(-1.6, 1.6) : softness * g.uniform(-4.0, 4.0)));
    out.push_back(static_cast<float>(softness));
  };
  r.add(CHIARO_CASE(ssdfSoftened, 2, 1, scalars(1), "distance in radians, softness 0 or .01..1; 1e-5 of the softness", ofSoftness), distanceAndSoftness);
  r.add(CHIARO_CASE(ssdfExpanded, 2, 1, scalars(1), "stored distance, softness 0 or .01..1; 2e-4 of the softness, as it is read near its end", [](const float* x) {
          return std::max(1.0, 20.0 * static_cast<double>(x[1]) / kFloor);
        }),
        distanceAndSoftness);
  r.add(CHIARO_CASE(visibilitySource, 4, 3, scalars(3), "sharpness >= 0, 1..8 levels, ratio 1.5..8; shares: 1e-5 absolute, a level is stored to 4e-3",
                    [](const float*) { return 1.0 / kFloor; }),
        [](Generator& g, auto& out) {
          const double levels = std::floor(g.uniform(1, 8.999)), first = g.logUniform(0.1, 100), ratio = g.logUniform(1.5, 8);
          // Where levels give way to the SSDF, at a level's own sharpness, anywhere.
          const double last = first * std::pow(ratio, levels - 1);
          const double l = g.chance(0.3) ? last * g.logUniform(0.9, 1.8) : first * std::pow(ratio, std::floor(g.uniform(-1, levels + 1)));
          out.push_back(g.chance(0.5) ? static_cast<float>(l) : std::abs(g.sharpness()));
          for (const double v : {levels, first, ratio}) out.push_back(static_cast<float>(v));
        });
  r.add(CHIARO_CASE(clampedCosineMean, 2, 1, scalars(1), "cosine in [-1, 1], sharpness >= 0"), sineAndSharpness);
  r.add(CHIARO_CASE(clampedCosineIntegral, 2, 1, scalars(1), "cosine in [-1, 1], sharpness >= 0"), sineAndSharpness);
}

void addWarp(Registry& r) {
  const Scale oneAmplitude = [](const float* in) { return amplitudeScale(in[4]); };
  const Fill lobeAndViewer = [](Generator& g, auto& out) {
    const glm::vec3 axis(g.direction());
    const float l = g.sharpness();
    push(out, g.spoil(axis));
    out.push_back(l);
    out.push_back(g.amplitude());
    const glm::vec3 wo = g.partner(axis, 3.0);
    push(out, g.spoil(wo));
  };
  r.add(CHIARO_CASE(sgWarpIsotropic, 8, 5, lobes(1), "unit axes, sharpness >= 0", oneAmplitude), lobeAndViewer);
  r.add(CHIARO_CASE(sgWarpLobe3, 8, 15, lobes(3), "unit axes, sharpness >= 0", oneAmplitude), lobeAndViewer);
  r.add(CHIARO_CASE(sgWarpLobe5, 8, 25, lobes(5), "unit axes, sharpness >= 0", oneAmplitude), lobeAndViewer);
  r.add(CHIARO_CASE(sgWarpEnergy, 1, 2, scalars(2), "cosine in [-1, 1]"), [](Generator& g, auto& out) { out.push_back(g.spoil(static_cast<float>(g.uniform(-0.1, 1)))); });
}

void addAnisotropicWarp(Registry& r) {
  // The axis is computed, so its rounding moves the exponent by 2 sqrt(sharpness) times itself.
  Case c = CHIARO_CASE(sgWarpAnisotropic, 11, 2, scalars(2), "unit axes, sharpness .1..1e3: 5e-5 of max(value, 1e-3), the axis's rounding",
                       [](const float*) { return 1e-3 / kFloor; });
  c.tolerance = 5e-5;
  r.add(std::move(c), [](Generator& g, auto& out) {
    const glm::vec3 axis(g.direction());
    push(out, axis);
    const auto l = static_cast<float>(g.logUniform(0.1, 1e3));
    out.insert(out.end(), {l, static_cast<float>(g.logUniform(0.1, 1))});
    const glm::vec3 wo(g.tilted(axis, g.chance(0.1) ? g.logUniform(1e-6, 1) : g.uniform(0, 1.4)));
    push(out, wo);
    push(out, g.partner(2.0f * glm::dot(wo, axis) * axis - wo, l * 0.25));
  });
  // Off the borders between entries, which rounding may cross.
  r.add(CHIARO_CASE(warpChoice, 2, 3, scalars(3), "sharpness 1e-2..1e8, cosine 0..1, off the borders of entries"), [](Generator& g, auto& out) {
    out.push_back(static_cast<float>(std::exp2(std::floor(g.uniform(-6, 26)) + g.uniform(-0.49, 0.49))));
    out.push_back(static_cast<float>((std::floor(g.uniform(0, 10)) + g.uniform(-0.49, 0.49)) / 10));
  });
}

void addMaps(Registry& r) {
  const Fill anyDirection = [](Generator& g, auto& out) {
    glm::vec3 d(g.direction());
    // Close to the axes and planes, where maps have their poles, seams and folds.
    if (g.chance(0.3)) d[static_cast<int>(g.uniform(0, 2.999))] *= static_cast<float>(g.logUniform(1e-12, 1));
    if (g.chance(0.3)) d = glm::vec3(g.tilted(glm::round(g.direction()), g.logUniform(1e-9, 0.1)));
    if (glm::dot(d, d) == 0.0f) d = glm::vec3(0, 0, 1);
    if (g.chance(0.01)) d = glm::vec3(0);
    push(out, g.spoil(d));
  };
  const Fill unitSquare = [](Generator& g, auto& out) {
    for (int i = 0; i < 2; ++i) {
      const double near = g.logUniform(1e-9, 1);
      out.push_back(g.chance(0.01) ? g.pick({kNan, 0.0f, 1.0f, 0.5f}) : static_cast<float>(g.chance(0.7) ? g.uniform(0, 1) : g.chance(0.5) ? near : 1 - near));
    }
  };
  r.add(CHIARO_CASE(octahedralEncode, 3, 2, scalars(2), "any direction"), anyDirection);
  r.add(CHIARO_CASE(octahedralDecode, 2, 3, {{0, 3}}, "[0, 1]^2"), unitSquare);
  r.add(CHIARO_CASE(octahedralTexel, 3, 6, {{0, 1}, {1, 1}, {2, 3}, {5, 1}}, "resolution 2..4096, one texel beyond the border"),
        [](Generator& g, auto& out) {
          const double level = std::floor(g.uniform(1, 12.999));
          const double n = std::exp2(level);
          for (int i = 0; i < 2; ++i) {
            out.push_back(static_cast<float>(g.chance(0.1) ? g.pick({-1.0, 0.0, n - 1, n}) : std::floor(g.uniform(0, n))));
          }
          out.push_back(static_cast<float>(level));
        });
  r.add(CHIARO_CASE(equirectFromDirection, 3, 2, scalars(2), "any direction"), anyDirection);
  r.add(CHIARO_CASE(directionFromEquirect, 2, 3, {{0, 3}}, "[0, 1]^2"), unitSquare);
  r.add(CHIARO_CASE(shEvaluate, 3, 25, scalars(25), "unit directions; values cross zero: error over max(|Y|, .02): 2e-7 absolute", [](const float*) { return 0.02 / kFloor; }), [](Generator& g, auto& out) { push(out, g.spoil(glm::vec3(g.direction()))); });
  r.add(CHIARO_CASE(shConstants, 1, 3, scalars(3), "l = 0..4"), [](Generator& g, auto& out) { out.push_back(static_cast<float>(std::floor(g.uniform(0, 4.999)))); });
}

void addGgx(Registry& r) {
  const auto alpha = [](Generator& g) {
    return g.chance(0.03) ? g.pick({0.0f, 1.0f, kDenormal, 2.0f, kNan, kInfinity, -kInfinity}) : static_cast<float>(g.logUniform(1e-4, 1));
  };
  const auto cosine = [](Generator& g) {
    if (g.chance(0.03)) return g.pick({0.0f, 1.0f, -1.0f, 1.5f, kDenormal, kNan, kInfinity, -kInfinity});
    const double near = g.logUniform(1e-7, 1);
    return static_cast<float>(g.chance(0.5) ? g.uniform(0, 1) : g.chance(0.5) ? near : 1 - near);
  };
  r.add(CHIARO_CASE(ggxDistribution, 2, 1, scalars(1), "cosine in [0, 1], alpha in [1e-4, 1]"), [=](Generator& g, auto& out) { out.insert(out.end(), {cosine(g), alpha(g)}); });
  const auto localDirection = [](Generator& g) {
    glm::dvec3 d = g.chance(0.5) ? g.direction() : g.tilted(glm::dvec3(0, 0, 1), g.logUniform(1e-6, 1));
    d.z = std::abs(d.z);
    return g.spoil(glm::vec3(d));
  };
  r.add(CHIARO_CASE(ggxDistributionAnisotropic, 5, 1, scalars(1), "wh unit, z >= 0"), [=](Generator& g, auto& out) {
    push(out, localDirection(g));
    out.insert(out.end(), {alpha(g), alpha(g)});
  });
  r.add(CHIARO_CASE(ggxVisibility, 3, 1, scalars(1), "cosines in [0, 1], alpha in [1e-4, 1]"), [=](Generator& g, auto& out) { out.insert(out.end(), {cosine(g), cosine(g), alpha(g)}); });
  r.add(CHIARO_CASE(ggxVisibilityAnisotropic, 8, 1, scalars(1), "wo, wi unit"), [=](Generator& g, auto& out) {
    push(out, localDirection(g));
    push(out, localDirection(g));
    out.insert(out.end(), {alpha(g), alpha(g)});
  });
  r.add(CHIARO_CASE(ggxAlbedoAnisotropic, 5, 2, {{0, 2}}, "wo unit; both parts as a vector"), [=](Generator& g, auto& out) {
    push(out, localDirection(g));
    out.insert(out.end(), {alpha(g), alpha(g)});
  });
  // The power 1 / (2 alpha), up to 102, multiplies the error of the logarithm.
  Case sheenD = CHIARO_CASE(sheenDistribution, 2, 1, scalars(1), "cosine in [0, .995], alpha in [.0049, 1]");
  sheenD.tolerance = 5e-5;
  r.add(sheenD, [=](Generator& g, auto& out) { out.insert(out.end(), {static_cast<float>(g.uniform(0, 0.995)), static_cast<float>(g.logUniform(0.0049, 1))}); });
  Case sheenF = CHIARO_CASE(sheenReflectance, 4, 1, scalars(1), "cosines in (0, 1], of the half vector to .995, alpha in [.0049, 1]");
  sheenF.tolerance = 5e-5;
  r.add(sheenF, [=](Generator& g, auto& out) {
    out.insert(out.end(), {static_cast<float>(g.logUniform(1e-3, 1)), static_cast<float>(g.logUniform(1e-3, 1)), static_cast<float>(g.uniform(0, 0.995)),
                           static_cast<float>(g.logUniform(0.0049, 1))});
  });
  r.add(CHIARO_CASE(fresnelSchlick, 4, 3, scalars(3), "F0 and cosine in [0, 1]"), [=](Generator& g, auto& out) {
    for (int i = 0; i < 3; ++i) out.push_back(g.spoil(static_cast<float>(g.uniform(0, 1))));
    out.push_back(cosine(g));
  });
  r.add(CHIARO_CASE(ggxMixtureLobes, 1, 20, scalars(20), "alpha in [1e-4, 1]"), [=](Generator& g, auto& out) { out.push_back(alpha(g)); });
  r.add(CHIARO_CASE(ggxMixtureTerms, 1, 20, scalars(20), "constants"), [](Generator& g, auto& out) { out.push_back(static_cast<float>(g.uniform(0.5, 1))); });
  r.add(CHIARO_CASE(cosineLobes, 3, 20, scalars(20), "constants"), [](Generator& g, auto& out) { push(out, glm::vec3(0, 0, g.uniform(0.5, 1))); });
}

/// Kind, then widths 1e-4..1 or exponents 1..1e6; some at the ends and beyond.
void pushModel(Generator& g, std::vector<float>& out) {
  const int kind = static_cast<int>(g.uniform(0, lobe64::kModelCount - 1e-9));
  out.push_back(static_cast<float>(kind));
  const bool exponent = lobe64::modelHasExponent(kind);
  for (int i = 0; i < 2; ++i) {
    const double value = exponent ? g.logUniform(1, 1e6) : g.logUniform(1e-4, 1);
    out.push_back(g.chance(0.03) ? g.pick({0.0f, 1.0f, kDenormal, 2.0f, 1e-4f, 1e6f, 1e10f, kNan}) : static_cast<float>(value));
  }
}

lobe64::ReflectanceModel modelOf(const float* in) {
  return lobe64::reflectanceModel(static_cast<int>(in[0]), static_cast<double>(in[1]), static_cast<double>(in[2]));
}

double widthOf(const lobe64::ReflectanceModel& m, double x) { return lobe64::modelHasExponent(m.kind) ? std::sqrt(2 / (x + 1)) : x; }

/// A half vector where the distribution still counts, or anywhere.
glm::dvec3 halfVectorOf(Generator& g, const std::vector<float>& out) {
  const auto m = modelOf(&out[out.size() - 3]);
  if (g.chance(0.2) || std::isnan(m.x + m.y)) return g.direction();
  const double reach = g.uniform(0, 3.5), phi = g.uniform(0, 6.283185307179586);
  return glm::normalize(glm::dvec3(widthOf(m, m.x) * reach * std::cos(phi), widthOf(m, m.y) * reach * std::sin(phi), 1));
}

void addModels(Registry& r) {
  // What is below 1e-7 of the peak is compared as absolute.
  const Scale peak = [](const float* in) {
    const auto m = modelOf(in);
    const double area = widthOf(m, m.x) * widthOf(m, m.y);
    return std::isnan(area) ? 1.0 : std::max(1.0, 0.1 / area);
  };
  r.add(CHIARO_CASE(logOnePlus, 1, 1, scalars(1), "x >= 0"), [](Generator& g, auto& out) { out.push_back(static_cast<float>(g.logUniform(1e-30, 1e30))); });
  r.add(CHIARO_CASE(ndfValue, 6, 1, scalars(1), "six models, widths 1e-4..1, exponents 1..1e6; wh unit, any side"), [](Generator& g, auto& out) {
    pushModel(g, out);
    push(out, g.spoil(glm::vec3(halfVectorOf(g, out))));
  });
  const Fill modelAndDirections = [](Generator& g, auto& out) {
    pushModel(g, out);
    const glm::dvec3 wh = halfVectorOf(g, out);
    glm::dvec3 wo = g.direction();
    if (g.chance(0.3)) wo = g.tilted(glm::dvec3(0, 0, 1), 1.5707963 - g.logUniform(1e-6, 1));
    if (g.chance(0.95)) wo.z = std::abs(wo.z);
    const glm::dvec3 wi = g.chance(0.1) ? g.direction() : glm::normalize(2 * glm::dot(wo, wh) * wh - wo);
    push(out, glm::vec3(wo));
    push(out, glm::vec3(wi));
    if (g.chance(0.01)) out[out.size() - 1 - static_cast<std::size_t>(g.uniform(0, 5.999))] = kNan;
  };
  r.add(CHIARO_CASE(smoothTimesCosine, 9, 1, scalars(1), "six models; wo, wi unit, any side", peak), modelAndDirections);
  Case whole = CHIARO_CASE(reflectanceTimesCosine, 10, 3, scalars(3), "six models; wo, wi unit, any side; F0 0 to 1; exponents up to 16 of a rounded half vector: 3e-5", peak);
  whole.tolerance = 3e-5;
  r.add(std::move(whole), [=](Generator& g, auto& out) {
    modelAndDirections(g, out);
    out.push_back(static_cast<float>(g.uniform(0, 1)));
  });
  // A chain of mirrors, exponents and quotients: where a string's end meets the horizon one rounding moves an amplitude by 1e-4 of the peak.
  Case elongated = CHIARO_CASE(elongatedLobes, 9, 2, scalars(2), "six models, widths .02..1, exponents 1..1e3, view cosine above .2: 2e-4 of max(value, .05 peak)",
                               [=](const float* in) { return 0.05 / kFloor * peak(in); });
  elongated.tolerance = 2e-4;
  r.add(std::move(elongated), [](Generator& g, auto& out) {
    const int kind = static_cast<int>(g.uniform(0, lobe64::kModelCount - 1e-9));
    out.push_back(static_cast<float>(kind));
    for (int i = 0; i < 2; ++i) out.push_back(static_cast<float>(lobe64::modelHasExponent(kind) ? g.logUniform(1, 1e3) : g.logUniform(0.02, 1)));
    glm::dvec3 wo = g.direction();
    wo.z = std::abs(wo.z) + 0.25;
    wo = glm::normalize(wo);
    const glm::dvec3 wh = halfVectorOf(g, out);
    push(out, glm::vec3(wo));
    push(out, glm::vec3(glm::normalize(2 * glm::dot(wo, wh) * wh - wo)));
  });
  r.add(CHIARO_CASE(ndfLobes, 3, 6, scalars(6), "six models"), [](Generator& g, auto& out) { pushModel(g, out); });
  r.add(CHIARO_CASE(roughReflectionShare, 2, 1, scalars(1), "six models, alpha 1e-4..1, between the passage's ends"), [](Generator& g, auto& out) {
    const int kind = static_cast<int>(g.uniform(0, lobe64::kModelCount - 1e-9));
    out.push_back(static_cast<float>(kind));
    // Near its zero the share is the square of a difference: there the rounding of alpha alone is all that is left, so the passage starts a hundredth in.
    const double from = kind == lobe64::kGgx ? 0.45 : 0.5, root = from + g.uniform(0.01, 0.15);
    out.push_back(static_cast<float>(g.chance(0.2) ? g.pick({1e-4f, 0.01f, 0.1f, 0.2f, 0.5f, 1.0f}) : root * root));
  });
  r.add(CHIARO_CASE(stringLobes, 2, 20, scalars(20), "sharpness 1e-3..1e8, ratio 1..1e4"), [](Generator& g, auto& out) {
    const double broad = g.logUniform(1e-3, 1e6);
    out.push_back(static_cast<float>(broad * (g.chance(0.1) ? 1.0 : g.logUniform(1, 1e4))));
    out.push_back(static_cast<float>(broad));
  });
}

void addAreaLights(Registry& r) {
  r.add(CHIARO_CASE(sphereCap, 4, 7, {{0, 3}, {3, 1}, {4, 1}, {5, 1}, {6, 1}}, "1e-3..1e3 m away, radius up to .999 of that, and 0"), [](Generator& g, auto& out) {
    const double distance = g.logUniform(1e-3, 1e3);
    push(out, glm::vec3(distance * g.direction()));
    out.push_back(g.chance(0.1) ? 0.0f : static_cast<float>(distance * (1 - g.logUniform(1e-3, 1)) * g.logUniform(1e-4, 1)));
  });
  // The height over the disk's plane is a difference, so what is near the plane is known to 1e-6 of the distance only.
  Case disk = CHIARO_CASE(diskCap, 7, 3, {{0, 3}}, "height over its plane at least .05 of distance and radius; error over max(value, 1e-7 / size^2): 2e-5",
                          [](const float* in) { return 1.0 / (in[0] * in[0] + in[1] * in[1] + in[2] * in[2] + in[3] * in[3]); });
  disk.tolerance = 2e-5;
  r.add(std::move(disk), [](Generator& g, auto& out) {
    const double distance = g.logUniform(1e-3, 1e3);
    const glm::dvec3 way = g.direction();
    glm::dvec3 towards = g.direction();
    for (int i = 0; i < 100 && glm::dot(towards, way) > -0.05; ++i) towards = g.direction();
    push(out, glm::vec3(distance * towards));
    out.push_back(g.chance(0.1) ? 0.0f : static_cast<float>(distance * g.logUniform(1e-4, 1)));
    push(out, glm::vec3(way));
  });
  // On the light's edge the cosine's own rounding is the light's width; there the share is small, so errors are over the width.
  r.add(CHIARO_CASE(capIrradianceShare, 2, 1, scalars(1), "angular radius 1e-6..pi/2, cosine in [-1, 1]; error over max(value, .02)", [](const float*) { return 0.02 / kFloor; }), [](Generator& g, auto& out) {
    const double s = g.logUniform(1e-6, 1.5707);
    out.push_back(static_cast<float>(s));
    out.push_back(static_cast<float>(g.chance(0.7) ? std::sin(s) * g.uniform(-1, 1) : g.uniform(-1, 1)));
  });
  // Where a sharp lobe crosses a wide light's edge, the angle between them (rounded to 1e-7) counts in units of the lobe's width: 1e-4.
  Case under = CHIARO_CASE(capMeanUnderLobe, 6, 5, {{0, 1}, {1, 1}, {2, 3}}, "angular radius 1e-6..pi/2, sharpness 1e-3..1e6; mean over max(value, .05 of the most); edge of sharp lobes: 1e-4",
                           [](const float* in) {
                             const double most = std::min(1.0 / (3.14159 * std::sin(in[0]) * std::sin(in[0])), lobe64::vmfAmplitude(in[4]));
                             return std::max(1.0, most) * 0.05 / kFloor;
                           });
  under.tolerance = 1e-4;
  r.add(std::move(under), [](Generator& g, auto& out) {
    const double sharpness = g.logUniform(1e-3, 1e6), s = g.logUniform(1e-6, 1.5707);
    out.push_back(static_cast<float>(s));
    const glm::vec3 axis(0, 0, 1);
    push(out, g.chance(0.5) ? g.partner(axis, sharpness) : glm::vec3(g.tilted(glm::dvec3(axis), std::min(3.1, s * g.uniform(0, 2)))));
    out.push_back(static_cast<float>(sharpness));
    out.push_back(static_cast<float>(g.logUniform(1e-4, 1)));
  });
}

void addDisplay(Registry& r) {
  const Fill unit = [](Generator& g, auto& out) { out.push_back(g.spoil(static_cast<float>(g.chance(0.5) ? g.uniform(-0.1, 1.1) : g.logUniform(1e-9, 1)))); };
  r.add(CHIARO_CASE(srgbEncode, 1, 1, scalars(1), "[0, 1], clamped"), unit);
  r.add(CHIARO_CASE(srgbDecode, 1, 1, scalars(1), "[0, 1], clamped"), unit);
  r.add(CHIARO_CASE(displayEncode, 4, 9, scalars(9), "radiance 1e-6..1e4; error over max(value, .1): 1e-6 absolute, an 8-bit step is 4e-3", [](const float*) { return 0.1 / kFloor; }), [](Generator& g, auto& out) {
    const double level = g.logUniform(1e-6, 1e4);
    for (int i = 0; i < 3; ++i) out.push_back(static_cast<float>(g.chance(0.05) ? 0 : level * g.logUniform(0.1, 1)));
    out.push_back(static_cast<float>(g.logUniform(0.1, 10)));
  });
}

void addSpecular(Registry& r) {
  r.add(CHIARO_CASE(incidenceTangent, 6, 3, {{0, 3}}, "unit n, wo above it"), [](Generator& g, auto& out) {
    const glm::vec3 n(g.direction());
    glm::vec3 wo = g.partner(n, 3.0);
    if (glm::dot(n, wo) < 0) wo = -wo;
    push(out, n);
    push(out, wo);
  });
  r.add(CHIARO_CASE(cosineWeightedAxis, 7, 3, {{0, 3}}, "unit axis, n; sharpness .3..1e6"), [](Generator& g, auto& out) {
    const glm::vec3 axis(g.direction());
    push(out, axis);
    out.push_back(static_cast<float>(g.logUniform(0.3, 1e6)));
    push(out, g.partner(axis, 3.0));
  });
  r.add(CHIARO_CASE(alphaUnderLight, 2, 1, scalars(1), "alpha in [1e-4, 1], sharpness >= 0"), [](Generator& g, auto& out) {
    out.insert(out.end(), {static_cast<float>(g.logUniform(1e-4, 1)), static_cast<float>(g.logUniform(1e-6, 1e6))});
  });
  r.add(CHIARO_CASE(reflectanceTableLobe, 7, 8, {{0, 3}, {3, 1}, {4, 1}, {5, 1}, {6, 2}}, "entries of the fitted tables, width .01..1, cosine .001..1"),
        [](Generator& g, auto& out) {
          for (const auto& [low, high] : {std::pair{-3.0, 3.0}, {-3.0, 4.0}, {0.0, 1.0}, {0.0, 1.0}, {-1.5, 1.5}}) out.push_back(static_cast<float>(g.uniform(low, high)));
          out.push_back(static_cast<float>(g.logUniform(1e-3, 1)));
          out.push_back(static_cast<float>(g.logUniform(0.01, 1)));
        });
  r.add(CHIARO_CASE(shadingNormalTowards, 6, 3, {{0, 3}}, "unit n, wo at most 135 degrees apart"), [](Generator& g, auto& out) {
    const glm::dvec3 n = g.direction();
    push(out, glm::vec3(n));
    push(out, glm::vec3(g.tilted(n, g.uniform(0, 2.356))));
  });
  // Not a primitive but a chain of a dozen steps, some ill-conditioned (the half vector of two nearly opposite directions, the tail of the
  // cosine below the horizon, the difference of two nearly equal variances), so it is held to 5e-5.
  Case anisotropic = CHIARO_CASE(anisotropicPart, 5, 18, {{0, 3}, {3, 1}, {4, 2}, {6, 3}, {9, 1}, {10, 2}, {12, 3}, {15, 1}, {16, 2}},
                                 "view cosine .1..1, alphas .02..1; weights over max(weight, .1); ill-conditioned chain: 5e-5",
                                 [](const float*) { return 0.1 / kFloor; });
  anisotropic.tolerance = 5e-5;
  r.add(std::move(anisotropic), [](Generator& g, auto& out) {
    glm::dvec3 wo = g.direction();
    wo.z = std::abs(wo.z) + 0.12;
    push(out, glm::vec3(glm::normalize(wo)));
    for (int i = 0; i < 2; ++i) out.push_back(static_cast<float>(g.logUniform(0.02, 1)));
  });
}

}  // namespace

const std::vector<Case>& allCases() {
  static const std::vector<Case> cases = [] {
    Registry r;
    addSpecialFunctions(r);
    addSphericalGaussians(r);
    addHalfSpaceAndCosine(r);
    addWarp(r);
    addAnisotropicWarp(r);
    addMaps(r);
    addGgx(r);
    addModels(r);
    addAreaLights(r);
    addDisplay(r);
    addSpecular(r);
    return std::move(r.cases);
  }();
  return cases;
}

}  // namespace chiaro::parity
