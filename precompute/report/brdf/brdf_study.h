#pragma once
/// The measurements of `chiaro-report brdf`: how well spherical Gaussians stand for the reflectance models of shaders/lobe/ndf.glsl.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "precompute/figure/figure.h"
#include "precompute/report/brdf/measured_study.h"

namespace chiaro {

/// Equation (11), distribution, smooth factor and warp together, of one model at one parameter.
struct ModelError {
  std::string model;
  double parameter = 0.0;     ///< m, alpha or n
  double paper = 0.0;         ///< one lobe, warped isotropically, smooth factor exact; views up to 75 degrees
  double ours = 0.0;          ///< what the shaders read (reflectance_table.h); views up to 75 degrees
  double worstView = 0.0;     ///< the largest error of ours for one view up to 75 degrees
  double worstAngle = 0.0;    ///< and which, degrees
  double oursAllViews = 0.0;  ///< ours, up to grazing
  double factored256 = 0.0;   ///< 256 factored terms, views up to 75 degrees; NaN where the grid does not resolve the lobe
  double limit = 0.0;         ///< what ours is held to; NaN: nothing
  bool holds() const { return !(ours > limit) && !(below256Wanted && !(ours < factored256 || factored256 != factored256)); }
  bool below256Wanted = false;  ///< at m, alpha <= .1 and n >= 500 ours must beat 256 factored terms
};

/// Equation (11) of a model that is not round, as lobes strung over light directions (elongated.glsl), views up to 75 degrees.
struct ElongatedError {
  static constexpr std::array<int, 4> kCounts{3, 5, 7, 9};  ///< lobes; GGX has three times as many
  std::string model;
  double x = 0.0, y = 0.0;  ///< widths or exponents along tangent and bitangent
  std::array<double, 4> byCount{};
  double drawn = 0.0;  ///< of GGX, whose default in the renderer is longer strings by half vectors (specular.glsl): better in pictures, worse here; NaN: the above
};

struct BrdfStudy {
  bool quick = false;
  double seconds = 0.0;
  std::vector<Figure> figures;
  std::vector<ModelError> models;
  std::vector<ElongatedError> elongated;
  MeasuredStudy measured;  ///< empty unless it was asked for
};

/// quick: coarse tables and grids, fewer parameters, for tests; its figures are good to some 20 %. Deterministic whatever `threads`.
BrdfStudy studyBrdfs(bool quick, int threads, const std::function<void(const std::string&, double)>& progress);

/// The text of shaders/lobe/warp_choice.glsl: which warp has the least error at each sharpness and cosine, measured.
std::string warpChoiceText(int threads);

/// Squared error of warp `method` (kWarpIsotropic...) of one Cook-Torrance lobe of this half-vector sharpness, its smooth factor exact.
double warpError(int method, double sharpness, double cosine);

}  // namespace chiaro
