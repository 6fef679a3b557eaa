#pragma once
/// View slices of the round reflectance models of shaders/lobe/ndf.glsl, fitted as SG lobes over light directions: distribution, smooth factor,
/// cosine, warp and off-specular shift at once. Independent of any scene; made at start, for the models that a scene has.

#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Entries of shaders/lobe/reflectance.glsl, layer by layer: texel (root of width i, root of cosine j) of layer k at
/// [(k * cosineCount + j) * widthCount + i].
///
/// Per texel the lobes' axes, sharpnesses and amplitudes are the least-squares fit (Levenberg and Marquardt) to rho (n.wi) over light
/// directions, started from the texel beside it so that neighbours interpolate. Amplitudes are then split between what F0 scales
/// and what Fresnel adds, (1 - wo.wh)^5, by non-negative least squares.
struct ReflectanceTable {
  static constexpr int kWidths = 17, kCosines = 25;  ///< enough: interpolation costs less than the fit's own error
  int kind = 0;                                      ///< kCookTorrance .. kGgx
  int widthCount = 0;
  int cosineCount = 0;
  std::vector<glm::vec4> entries;
};

/// Deterministic whatever `threads` (0: all cores). Some seconds of one core.
ReflectanceTable makeReflectanceTable(int kind, int widthCount = ReflectanceTable::kWidths,
                                      int cosineCount = ReflectanceTable::kCosines, int threads = 0);

/// The table of default size, made when it is first asked for and kept while the process lives.
const ReflectanceTable& reflectanceTableOf(int kind);

/// A lobe as it stands in the tangent frame of a viewer in the xz plane.
struct SliceLobe {
  glm::dvec3 axis{0.0, 0.0, 1.0};
  double sharpness = 0.0;
  double weight = 0.0;         ///< integral over the sphere, of the part that F0 scales
  double fresnelWeight = 0.0;  ///< of the part that Fresnel adds
};

/// The nine lobes that a shader reads at this width and cosine: bilinear, kReflectanceLobes of them.
std::vector<SliceLobe> reflectanceLobes(const ReflectanceTable& table, double width, double cosineOut);

/// One fit of `count` lobes in the plane of incidence (1, 3, 5 or 7) to one slice, F = 1, from several starts: what a table could reach.
std::vector<SliceLobe> fitSliceLobes(int kind, double parameter, double cosineOut, int count);

}  // namespace chiaro
