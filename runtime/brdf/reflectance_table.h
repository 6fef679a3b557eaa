#pragma once
/// View slices of the round reflectance models of shaders/lobe/ndf.glsl, fitted as SG lobes over light directions: distribution, smooth factor,
/// cosine, warp and off-specular shift at once. Independent of any scene.

#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Entries of shaders/lobe/reflectance.glsl, layer by layer: texel (root of width i, root of cosine j) of layer k at
/// [(k * cosineCount + j) * widthCount + i].
///
/// Per texel the lobes' axes, sharpnesses and amplitudes are the least-squares fit (runtime/brdf/slice_fit.h) to rho (n.wi) over light directions,
/// tails weighted up, started from the texel beside it so that neighbours interpolate. Amplitudes are then split between what F0 scales
/// and what Fresnel adds, (1 - wo.wh)^5, by non-negative least squares; GGX's bring its exact albedo.
struct ReflectanceTable {
  static constexpr int kWidths = 17, kCosines = 25;  ///< enough: interpolation costs less than the fit's own error
  int kind = 0;                                      ///< kCookTorrance .. kAshikhminShirley
  int widthCount = 0;
  int cosineCount = 0;
  std::vector<glm::vec4> entries;
};

/// The table of default size of a model (kAshikhminShirley: of equal exponents), as the build fitted it (reflectance_fit.h).
const ReflectanceTable& reflectanceTableOf(int kind);

/// A lobe as it stands in the tangent frame of a viewer in the xz plane.
struct SliceLobe {
  glm::dvec3 axis{0.0, 0.0, 1.0};
  double sharpness = 0.0;
  double weight = 0.0;         ///< integral over the sphere, of the part that F0 scales
  double fresnelWeight = 0.0;  ///< of the part that Fresnel adds
};

/// The lobes that a shader reads at this width and cosine: bilinear, lobe64::reflectanceLobeCount(kind) of them.
std::vector<SliceLobe> reflectanceLobes(const ReflectanceTable& table, double width, double cosineOut);

}  // namespace chiaro
