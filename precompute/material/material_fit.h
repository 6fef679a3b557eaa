#pragma once
/// From reflectance data to the parameters of a microfacet model, by nonlinear least squares (Ceres).

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "precompute/material/fit_samples.h"

namespace chiaro {

/// What is made small, over pairs of directions weighted by their solid angles, all channels alike:
enum class FitMetric {
  logarithmic,  ///< differences of log(1 + rho (n.wi)) (Low et al. 2012): the peak counts, but does not drown the rest
  cosine,       ///< differences of rho (n.wi) (Ngan et al. 2005)
};

/// rho(c) = diffuse(c) (1 - max F) / pi + F(c) ((1 - share) ndf(width) + share ndf(width2)) smooth: the reflectance that a material of a scene has.
/// Families of others (Ngan's) have F without the diffuse part's loss.
struct FitFamily {
  enum class Fresnel {
    schlick,  ///< F(c) = f90 (f0(c) + (1 - f0(c)) w), w = (1 - wo.wh)^5; the diffuse part gets what is left
    scaled,   ///< scale(c) (F0 + (1 - F0) w), one F0 for all channels
    none,     ///< scale(c)
  };
  std::string name;
  Fresnel fresnel = Fresnel::schlick;
  std::function<double(double width, const lobe64::Vec3& wo, const lobe64::Vec3& wi)> lobe;  ///< 1/sr, without F
  std::function<double(double width)> published;  ///< the width as the family itself calls it (an exponent, for some)
};

/// The round forms of the models of shaders/lobe/ndf.glsl. Exponents n are fitted as the width sqrt(2 / (n + 1)).
FitFamily modelFamily(int kind);
const char* modelJsonName(int kind);  ///< ggx, cookTorrance, ...: as CHIARO_materials_reflectance has them
std::optional<int> modelFromJsonName(const std::string& name);

struct FitOptions {
  FitMetric metric = FitMetric::logarithmic;
  int lobes = 1;        ///< 1 or 2: distributions that are added up
  bool fitF90 = false;  ///< else F90 is 1
  int starts = 2;       ///< widths, the best of a scan, that the nonlinear fit starts from
};

struct MaterialFit {
  double width = 0.1, width2 = 0.1, share = 0.0;  ///< the second lobe's, and its part of the distribution
  double f90 = 1.0;                               ///< schlick: F90; scaled: F0; none: 1
  lobe64::Vec3 diffuse{0.0};
  lobe64::Vec3 specular{0.0};  ///< schlick: F0 over F90; else the scale
  double error = 0.0;          ///< root of the weighted mean square of the metric's differences
  double cosineError = 0.0;    ///< the same by FitMetric::cosine: what Ngan et al. tabulate

  lobe64::Vec3 f0() const { return f90 * specular; }
};

/// Widths are looked for here: the finest bins of a MERL file say no more.
inline constexpr double kLeastFitWidth = 1e-3, kMostFitWidth = 1.0;

/// Deterministic. Samples are used as they are: their peak need not be resolved, but then its width is a guess.
MaterialFit fitMaterial(const std::vector<FitSample>& samples, const FitFamily& family, const FitOptions& options);

/// rho of a fit.
ReflectanceFunction fittedReflectance(const FitFamily& family, const MaterialFit& fit);

}  // namespace chiaro
