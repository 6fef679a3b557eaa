#include "precompute/report/brdf/brdf_study.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <limits>

#include "precompute/parallel.h"
#include "precompute/report/brdf/cosine_figure.h"
#include "precompute/report/brdf/factorisation.h"
#include "precompute/report/brdf/view_error.h"
#include "runtime/brdf/reflectance_table.h"

namespace chiaro {
namespace {

using namespace lobe64;

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
const double kWidestView = 75.0 / 180.0 * kPi;
constexpr const char* kNames[] = {"Cook-Torrance", "Beckmann", "Blinn-Phong", "Ward", "GGX", "Ashikhmin-Shirley"};
constexpr const char* kParameters[] = {"m", "m", "n", "alpha", "alpha", "n_u / n_v"};

/// The smooth factor exact, `count` half-vector lobes (of GGX; others have one), each warped.
Reconstruction warped(const ReflectanceModel& model, const std::vector<SphericalGaussian>& lobes, int way) {
  return [=](const Vec3& wo) -> Slice {
    std::vector<SphericalGaussian> round;
    std::vector<AnisotropicGaussian> elongated;
    for (const SphericalGaussian& lobe : lobes) {
      if (way == kWarpAnisotropic)
        elongated.push_back(sgWarpAnisotropic(lobe, wo));
      else
        for (int k = 0; k < warpLobeCount(way); ++k) round.push_back(sgWarpLobe(lobe, wo, warpLobeCount(way), k));
    }
    return [=](const Vec3& wi) {
      double sum = 0.0;
      for (const auto& lobe : round) sum += sgEvaluate(lobe, wi);
      for (const auto& lobe : elongated) sum += asgEvaluate(lobe, wi);
      return sum * smoothTimesCosine(model, wo, wi);
    };
  };
}

Reconstruction chosen(const ReflectanceModel& model, const SphericalGaussian& lobe, bool closedForm) {
  return [=](const Vec3& wo) -> Slice {
    return warped(model, {lobe}, warpChoice(lobe.sharpness, warpCosine(wo, lobe.axis), closedForm))(wo);
  };
}

/// No warp: the mixture over half vectors.
Reconstruction unwarped(const ReflectanceModel& model, const std::vector<SphericalGaussian>& lobes) {
  return [=](const Vec3& wo) -> Slice {
    return [=](const Vec3& wi) {
      const Vec3 wh = halfVector(wo, wi);
      double sum = 0.0;
      for (const auto& lobe : lobes) sum += sgEvaluate(lobe, wh);
      return sum * smoothTimesCosine(model, wo, wi);
    };
  };
}

/// What a shader reads.
Reconstruction tabulated(const ReflectanceTable& table, double width) {
  return [&table, width](const Vec3& wo) -> Slice {
    std::vector<SphericalGaussian> lobes;
    for (const SliceLobe& lobe : reflectanceLobes(table, width, wo.z))
      lobes.push_back(
          sphericalGaussian(lobe.axis, lobe.sharpness, (lobe.weight + lobe.fresnelWeight) * vmfAmplitude(lobe.sharpness)));
    return [lobes](const Vec3& wi) {
      double sum = 0.0;
      for (const auto& lobe : lobes) sum += sgEvaluate(lobe, wi);
      return sum;
    };
  };
}

/// Brushed GGX as the renderer draws it: strings by half vectors, scaled to its albedo.
Reconstruction brushedGgx(double alphaX, double alphaY) {
  return [=](const Vec3& wo) -> Slice {
    constexpr int kTerms = 3;
    const int parts = anisotropicPartCount(std::max(alphaX / alphaY, alphaY / alphaX));
    std::vector<SphericalGaussian> all;
    double whole = 0.0;
    for (int term = 0; term < kTerms; ++term)
      for (int k = 0; k < parts; ++k) {
        const SpecularLobe lobe = anisotropicPart(ggxMixtureTerm(kTerms, term), parts, k, Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), alphaX, alphaY, wo);
        const double weight = lobe.weight + lobe.fresnelWeight;
        if (!(weight > 1e-4)) continue;
        whole += weight;
        all.push_back(sphericalGaussian(lobe.axis, lobe.sharpness, weight * vmfAmplitude(lobe.sharpness)));
      }
    const auto albedo = ggxAlbedoAnisotropic(wo, alphaX, alphaY);
    for (auto& lobe : all) lobe.amplitude *= (albedo.x + albedo.y) / std::max(whole, 1e-6);
    return [all](const Vec3& wi) {
      double sum = 0.0;
      for (const auto& lobe : all) sum += sgEvaluate(lobe, wi);
      return sum;
    };
  };
}

/// Strung lobes with matched amplitudes, for models of any shape.
Reconstruction elongated(const ReflectanceModel& model, int count) {
  return [=](const Vec3& wo) -> Slice {
    std::vector<SphericalGaussian> all;
    const int terms = model.kind == kGgx ? 3 : 1;
    for (int term = 0; term < terms; ++term) {
      SphericalGaussian lobes[9];
      elongatedLobes(model, wo, count, terms, term, lobes);
      all.insert(all.end(), lobes, lobes + count);
    }
    return [all](const Vec3& wi) {
      double sum = 0.0;
      for (const auto& lobe : all) sum += sgEvaluate(lobe, wi);
      return sum;
    };
  };
}

SphericalGaussian aboutNormal(const Vec2& lobe) { return sphericalGaussian(Vec3(0, 0, 1), lobe.y, lobe.x); }

std::vector<SphericalGaussian> mixture(int kind, double parameter, int count) {
  std::vector<SphericalGaussian> lobes;
  for (int k = 0; k < count; ++k) lobes.push_back(aboutNormal(ndfMixtureLobe(kind, parameter, count, k)));
  return lobes;
}

std::vector<double> parametersOf(int kind, bool quick) {
  if (modelHasExponent(kind))
    return quick ? std::vector<double>{20, 100, 1000, 10000}
                 : std::vector<double>{1, 3, 10, 20, 30, 50, 100, 200, 500, 1000, 3000, 10000};
  return quick ? std::vector<double>{.02, .1, .4, 1}
               : std::vector<double>{.02, .03, .05, .07, .1, .15, .2, .25, .3, .4, .5, .6, .7, .85, 1};
}

/// Half a lobe's deviation must span an azimuth of the grid; what is sharper is harder still for a factorisation.
bool resolved(double width, int azimuths) { return width * azimuths >= 12.0; }

void push(Curve& curve, double x, double y) { curve.x.push_back(x), curve.y.push_back(y); }

/// The figure of one round model, and its line of the table.
struct ModelStudy {
  Figure figure;
  std::vector<ModelError> errors;
};

ModelStudy studyModel(int kind, const ReflectanceTable& table, bool quick, int threads,
                      const std::function<void(double)>& progress) {
  const std::vector<double> parameters = parametersOf(kind, quick);
  const std::vector<int> terms{16, 64, 256};
  Quadrature quadrature;
  if (quick) quadrature = {.views = 16, .viewAzimuths = 2, .radii = 64, .azimuths = 24};
  const int polar = quick ? 56 : 112, azimuths = quick ? 128 : 256;
  const int more = kind == kGgx ? 3 : 1;
  struct Point {
    ModelError error;
    double half = 0, halfMore = 0, one = 0, three = 0, five = 0;
    std::vector<double> factored;
  };
  std::vector<Point> points(parameters.size());
  StepCounter steps(parameters.size(), progress);
  parallelBlocks(threads, parameters.size(), [&](std::size_t i) {
    const double parameter = parameters[i], width = modelWidth(kind, parameter);
    const ReflectanceModel model = reflectanceModel(kind, parameter, parameter);
    Point& point = points[i];
    ModelError& error = point.error;
    error.model = kNames[kind];
    error.parameter = parameter;
    // GGX's curvature at the peak suits nothing but the peak; for the others the paper's lobe is its own.
    const auto paper = kind == kGgx ? mixture(kind, parameter, 1) : std::vector{aboutNormal(ndfPaperLobe(kind, parameter))};
    point.half = viewError(model, unwarped(model, paper), kHalfPi, quadrature);
    point.halfMore = viewError(model, unwarped(model, mixture(kind, parameter, more)), kHalfPi, quadrature);
    point.one = viewError(model, warped(model, paper, kWarpIsotropic), kHalfPi, quadrature);
    point.three = viewError(model, warped(model, mixture(kind, parameter, more), kWarpThree), kHalfPi, quadrature);
    point.five = viewError(model, warped(model, mixture(kind, parameter, more), kWarpFive), kHalfPi, quadrature);
    error.paper = viewError(model, warped(model, paper, kWarpIsotropic), kWidestView, quadrature);
    const Reconstruction ours = tabulated(table, width);
    error.ours = viewError(model, ours, kWidestView, quadrature);
    error.oursAllViews = viewError(model, ours, kHalfPi, quadrature);
    for (double degrees = 0.0; degrees <= 75.0; degrees += quick ? 15.0 : 5.0) {
      const Vec3 wo(std::sin(degrees / 180.0 * kPi), 0.0, std::cos(degrees / 180.0 * kPi));
      const double one = sliceError(model, wo, ours(wo), quadrature).relative();
      if (!(one <= error.worstView)) error.worstView = one, error.worstAngle = degrees;
    }
    point.factored.assign(terms.size(), kUndefined);
    error.factored256 = kUndefined;
    if (resolved(width, azimuths)) {
      point.factored = factorisationErrors(model, kHalfPi, polar, azimuths, terms);
      error.factored256 = factorisationErrors(model, kWidestView, polar, azimuths, terms).back();
    }
    const bool exponent = modelHasExponent(kind);
    error.limit = exponent ? (parameter >= 20 ? 1e-2 : kUndefined) : parameter <= 0.4 ? 1e-2 : 2e-2;
    error.below256Wanted = exponent ? parameter >= 500 : parameter <= 0.1;
    steps.add();
  });
  ModelStudy study;
  study.figure = {.id = std::string("error_") + std::string(kNames[kind]).substr(0, std::string(kNames[kind]).find('-')),
                  .title = std::string(kNames[kind]) + ": squared error, equation (11)",
                  .xLabel = kParameters[kind],
                  .yLabel = "squared relative error",
                  .note = {},
                  .logX = true,
                  .logY = true,
                  .curves = {}};
  for (char& c : study.figure.id) c = static_cast<char>(std::tolower(c));
  Curve curves[] = {{"1 lobe, isotropic warp", {}, {}, true},
                    {"3-lobe warp", {}, {}},
                    {"5-lobe warp", {}, {}},
                    {std::to_string(lobe64::reflectanceLobeCount(kind)) + " fitted lobes (ours)", {}, {}},
                    {"ours, views to 75 deg", {}, {}},
                    {"16 factored terms", {}, {}, true},
                    {"64 factored terms", {}, {}, true},
                    {"256 factored terms", {}, {}, true},
                    {"1 lobe, no warp", {}, {}, true}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    const double values[] = {p.one,         p.three,       p.five, p.error.oursAllViews, p.error.ours, p.factored[0],
                             p.factored[1], p.factored[2], p.half};
    for (std::size_t c = 0; c < std::size(curves); ++c) push(curves[c], parameters[i], values[c]);
    study.errors.push_back(p.error);
  }
  study.figure.curves.assign(std::begin(curves), std::end(curves));
  if (kind == kGgx) {
    Curve three{"3 lobes, no warp", {}, {}, true};
    for (std::size_t i = 0; i < points.size(); ++i) push(three, parameters[i], points[i].halfMore);
    study.figure.curves.push_back(three);
  }
  study.figure.note =
      "All views unless said. Warps keep the exact smooth factor; the fitted lobes hold it, the cosine and the warp together. A "
      "factorisation is left out "
      "where the grid does not resolve the lobe: there it is worse still.";
  return study;
}

Figure sharpnessFigure(int kind) {
  Figure figure{.id = kind == kBlinnPhong ? "sharpness_n" : "sharpness_m",
                .title = std::string(kNames[kind]) + ": sharpness of one lobe",
                .xLabel = kParameters[kind],
                .yLabel = "sharpness",
                .note = "Fitted: least squares over the hemisphere, peak 1. Analytic: the first term of Taylor's series.",
                .logX = true,
                .logY = true,
                .curves = {}};
  Curve fitted{"fitted", {}, {}}, analytic{"analytic (the paper)", {}, {}, true}, best{"analytic, second order", {}, {}, true};
  for (double step = 0; step <= 12; ++step) {
    const double parameter = kind == kBlinnPhong ? std::pow(10.0, step / 4) : std::pow(10.0, -1.6 + step / 7.5);
    const ReflectanceModel model = reflectanceModel(kind, parameter, parameter);
    const double paper = ndfPaperLobe(kind, parameter).y;
    // 1 - cos on a log scale, dense at the peak.
    const GaussRule rule = gaussLegendre(200, std::log(1e-7 / paper), 0.0);
    const auto error2 = [&](double sharpness) {
      double sum = 0.0;
      for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double u = std::exp(rule.node[i]),
                     d = ndfValue(model, Vec3(std::sqrt(u * (2.0 - u)), 0.0, 1.0 - u)) - std::exp(-sharpness * u);
        sum += rule.weight[i] * u * d * d;
      }
      return sum;
    };
    double low = 0.2 * paper, high = 8.0 * paper + 4.0;
    for (int i = 0; i < 120; ++i) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      (error2(a) < error2(b) ? high : low) = error2(a) < error2(b) ? b : a;
    }
    push(fitted, parameter, 0.5 * (low + high));
    push(analytic, parameter, paper);
    push(best, parameter, kind == kBlinnPhong ? paper + 0.76 : paper + 0.25);
  }
  figure.curves = {fitted, analytic, best};
  return figure;
}

Figure warpFigure(bool quick, int threads) {
  Figure figure{.id = "warp",
                .title = "Cook-Torrance: the error of the warp",
                .xLabel = "m",
                .yLabel = "squared relative error",
                .note = {},
                .logX = true,
                .logY = true,
                .curves = {}};
  Quadrature quadrature;
  if (quick) quadrature = {.views = 16, .viewAzimuths = 2, .radii = 64, .azimuths = 24};
  const std::vector<double> parameters = parametersOf(kCookTorrance, quick);
  std::vector<std::vector<double>> values(parameters.size());
  parallelBlocks(threads, parameters.size(), [&](std::size_t i) {
    const double m = parameters[i];
    const ReflectanceModel model = reflectanceModel(kCookTorrance, m, m);
    const SphericalGaussian lobe = aboutNormal(ndfPaperLobe(kCookTorrance, m));
    for (const int way : {kWarpIsotropic, kWarpAnisotropic, kWarpThree, kWarpFive})
      values[i].push_back(viewError(model, warped(model, {lobe}, way), kHalfPi, quadrature));
    values[i].push_back(viewError(model, chosen(model, lobe, true), kHalfPi, quadrature));
    values[i].push_back(viewError(model, chosen(model, lobe, false), kHalfPi, quadrature));
  });
  for (const char* name : {"isotropic", "anisotropic (ASG)", "3 lobes", "5 lobes", "chosen, round lobes", "chosen, any"})
    figure.curves.push_back({name, {}, {}});
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (std::size_t c = 0; c < figure.curves.size(); ++c) push(figure.curves[c], parameters[i], values[i][c]);
  figure.note =
      "All views, one half-vector lobe, smooth factor exact. Chosen: by sharpness and cosine, from the measured table "
      "shaders/lobe/warp_choice.glsl. "
      "For sharp lobes the isotropic warp's error does not fall with sharpness: it is 2 (1 - sqrt c)^2 / (1 + c), c = dot(n, "
      "wo).";
  return figure;
}

/// Over half vectors, both rules, beside the factorisation.
Figure elongatedFigure(bool quick, int threads) {
  Figure figure{.id = "elongated",
                .title = "Ashikhmin-Shirley, n_u = 10 n_v: squared error, equation (11)",
                .xLabel = "n_u",
                .yLabel = "squared relative error",
                .note = {},
                .logX = true,
                .logY = true,
                .curves = {}};
  const std::vector<double> exponents = quick ? std::vector<double>{100} : std::vector<double>{30, 100, 200, 400, 1000};
  const Quadrature quadrature = quick ? Quadrature{.views = 8, .viewAzimuths = 3, .radii = 48, .azimuths = 24}
                                      : Quadrature{.views = 16, .viewAzimuths = 4, .radii = 64, .azimuths = 36};
  std::vector<std::vector<double>> values(exponents.size());
  parallelBlocks(threads, exponents.size(), [&](std::size_t i) {
    const double nu = exponents[i], nv = nu / 10.0;
    const ReflectanceModel model = reflectanceModel(kAshikhminShirley, nu, nv);
    const auto string = [&](bool paper, int count) {
      std::vector<SphericalGaussian> lobes;
      for (int k = 0; k < count; ++k) {
        const StringLobe lobe = paper ? paperStringLobe(nu, nv, count, k) : ndfStringLobe(nu, nv, count, k);
        lobes.push_back(sphericalGaussian(Vec3(0.0, std::sin(lobe.angle), std::cos(lobe.angle)), lobe.sharpness, lobe.amplitude));
      }
      return lobes;
    };
    values[i] = {viewError(model, unwarped(model, string(true, 7)), kHalfPi, quadrature),
                 viewError(model, unwarped(model, string(false, 7)), kHalfPi, quadrature),
                 viewError(model, warped(model, string(false, 7), kWarpIsotropic), kHalfPi, quadrature),
                 viewError(model, elongated(model, 9), kHalfPi, quadrature)};
    const std::vector<double> factored = factorisationErrors(model, kHalfPi, quick ? 24 : 40, quick ? 48 : 96, {16, 64, 256});
    values[i].insert(values[i].end(), factored.begin(), factored.end());
  });
  for (const char* name : {"7 lobes, the paper's rule", "7 lobes, ours", "ours, isotropic warp", "9 lobes of light",
                           "16 factored terms", "64 factored terms", "256 factored terms"})
    figure.curves.push_back({name, {}, {}, figure.curves.size() == 0 || figure.curves.size() > 3});
  for (std::size_t i = 0; i < exponents.size(); ++i)
    for (std::size_t c = 0; c < figure.curves.size(); ++c) push(figure.curves[c], exponents[i], values[i][c]);
  figure.note =
      "All views. Both rules over half vectors; ours warped lobe by lobe; lobes strung over light directions (elongated.glsl). "
      "The paper's amplitudes are those of the distribution at the axes: lobes overlap and add up.";
  return figure;
}

/// Lobes strung over light directions, views to 75 degrees.
std::vector<ElongatedError> studyElongated(bool quick, int threads) {
  struct Kind {
    int kind;
    double x, y;
  };
  const std::vector<Kind> kinds = quick ? std::vector<Kind>{{kAshikhminShirley, 100, 10}, {kWard, .1, .3}, {kGgx, .1, .3}}
                                        : std::vector<Kind>{{kAshikhminShirley, 50, 25},
                                                            {kAshikhminShirley, 100, 10},
                                                            {kAshikhminShirley, 400, 40},
                                                            {kAshikhminShirley, 1000, 100},
                                                            {kAshikhminShirley, 10000, 500},
                                                            {kAshikhminShirley, 1000, 10},
                                                            {kWard, .05, .2},
                                                            {kWard, .1, .3},
                                                            {kWard, .1, .4},
                                                            {kBeckmann, .05, .2},
                                                            {kBeckmann, .1, .3},
                                                            {kBeckmann, .2, .4},
                                                            {kGgx, .02, .08},
                                                            {kGgx, .05, .2},
                                                            {kGgx, .1, .3},
                                                            {kGgx, .2, .4},
                                                            {kGgx, .3, .9}};
  const Quadrature quadrature = quick ? Quadrature{.views = 8, .viewAzimuths = 3, .radii = 48, .azimuths = 24}
                                      : Quadrature{.views = 16, .viewAzimuths = 5, .radii = 64, .azimuths = 36};
  std::vector<ElongatedError> errors(kinds.size());
  parallelBlocks(threads, kinds.size(), [&](std::size_t i) {
    const ReflectanceModel model = reflectanceModel(kinds[i].kind, kinds[i].x, kinds[i].y);
    errors[i] = {.model = kNames[kinds[i].kind], .x = kinds[i].x, .y = kinds[i].y, .byCount = {}, .drawn = kUndefined};
    for (std::size_t k = 0; k < errors[i].byCount.size(); ++k)
      errors[i].byCount[k] = viewError(model, elongated(model, ElongatedError::kCounts[k]), kWidestView, quadrature);
    errors[i].drawn = model.kind == kGgx ? viewError(model, brushedGgx(model.x, model.y), kWidestView, quadrature) : kUndefined;
  });
  return errors;
}

}  // namespace

double warpError(int method, double sharpness, double cosine) {
  const double m = std::sqrt(2.0 / sharpness);
  // Wider than the model's own range the same shape is meant.
  const ReflectanceModel model = reflectanceModel(kCookTorrance, std::min(m, 1.0), 0.0);
  const SphericalGaussian lobe = sphericalGaussian(Vec3(0, 0, 1), std::max(sharpness, 2.0), 1.0);
  const Vec3 wo(std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine);
  return sliceError(model, wo, warped(model, {lobe}, method)(wo), {.views = 1, .viewAzimuths = 1, .radii = 96, .azimuths = 48})
      .relative();
}

std::string warpChoiceText(int threads) {
  std::vector<int> choices(340);
  parallelBlocks(threads, 170, [&](std::size_t at) {
    const double sharpness = std::exp2(static_cast<double>(at / 10)), cosine = static_cast<double>(at % 10 + 1) / 10.0;
    double least[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int way = 0; way < 4; ++way) {
      const double error = warpError(way, sharpness, cosine);
      for (std::size_t only = 0; only < 2; ++only)
        // A little better is no reason for more lobes.
        if ((only == 0 || way != kWarpAnisotropic) && error < 0.98 * least[only] - 1e-7)
          least[only] = error, choices[170 * only + at] = way;
    }
  });
  std::string text =
      "// Made by `chiaro-report brdf --warp-choice shaders/lobe/warp_choice.glsl`; read by warp.glsl.\n"
      "// The warp of least squared error of a Cook-Torrance lobe, smooth factor exact: rows by sharpness 2^0 .. 2^16, columns "
      "by dot(wo, axis)\n"
      "// .1 .. 1; all four ways, then round lobes alone. 0 isotropic, 1 anisotropic, 2 three lobes, 3 five lobes.\n"
      "#ifndef CHIARO_CPP\n#include \"shaders/lobe/special.glsl\"\n#endif\n\nCONST int kWarpChoices[340] = {\n";
  for (std::size_t i = 0; i < choices.size(); ++i)
    text += (i % 10 == 0 ? "    " : " ") + std::to_string(choices[i]) +
            (i + 1 == choices.size() ? "};\n"
             : i % 10 == 9           ? ",\n"
                                     : ",");
  return text;
}

BrdfStudy studyBrdfs(bool quick, int threads, const std::function<void(const std::string&, double)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  BrdfStudy study;
  study.quick = quick;
  progress("cosine", 0.0);
  study.figures.push_back(cosineFigure());
  study.figures.push_back(sharpnessFigure(kCookTorrance));
  study.figures.push_back(sharpnessFigure(kBlinnPhong));
  for (const int kind : {kCookTorrance, kBlinnPhong, kGgx, kBeckmann, kWard}) {
    const std::string name = kNames[kind];
    progress("fitting " + name, 0.0);
    const ReflectanceTable& table = reflectanceTableOf(kind);
    ModelStudy one = studyModel(kind, table, quick, threads, [&](double done) { progress("measuring " + name, done); });
    study.figures.push_back(std::move(one.figure));
    study.models.insert(study.models.end(), one.errors.begin(), one.errors.end());
  }
  progress("elongated lobes", 0.0);
  study.figures.push_back(elongatedFigure(quick, threads));
  study.elongated = studyElongated(quick, threads);
  progress("warps", 0.0);
  study.figures.push_back(warpFigure(quick, threads));
  study.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return study;
}

}  // namespace chiaro
