#pragma once
/// GGX reflection tabulated as SG lobes over roughness and view angle, and its albedo. Independent of any scene; made once at start.

#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Entries of shaders/lobe/specular.glsl `specularTableLobe`, layer by layer: texel (roughness i, sqrt cosine j) of lobe k at
/// [(k * cosineCount + j) * roughnessCount + i].
///
/// Per entry the lobes' axes and sharpnesses come from the analytic warp of the four-term mixture (five lobes strung along the plane of
/// incidence each, moved by the cosine's pull); their amplitudes are the non-negative least-squares fit to the true slice
/// D V cos (1 - Fc) and D V cos Fc, Fc = (1 - wo.wh)^5, then scaled so that their integrals are the true ones.
struct SpecularTable {
  static constexpr int kLobeCount = 20;
  int roughnessCount = 0;
  int cosineCount = 0;
  std::vector<glm::vec4> entries;
};

/// Directional albedo of GGX: f0 * x + y; z is the mean of Fc over the cosine-weighted hemisphere (what a Fresnel layer keeps from the
/// diffuse base: (1 - f0) (1 - z)). Texel (roughness i of [0, 1], sqrt cosine j of [0, 1]) at [j * size + i].
struct AlbedoTable {
  int size = 0;
  std::vector<glm::vec3> entries;
};

/// Deterministic; `threads` 0 means all cores.
SpecularTable makeSpecularTable(int roughnessCount = 25, int cosineCount = 33, int threads = 0);
AlbedoTable makeAlbedoTable(int size = 64, int threads = 0);

/// (x, y) of AlbedoTable at one point, by quadrature over visible half vectors; error below 1e-3 for alpha >= 1e-3.
glm::dvec2 ggxAlbedo(double alpha, double cosineOut);

}  // namespace chiaro
