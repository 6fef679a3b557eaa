#pragma once
/// Directional albedo of GGX. Independent of any scene.

#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Directional albedo of GGX: f0 * x + y; z is the mean of Fc over the cosine-weighted hemisphere (what a Fresnel layer keeps from the
/// diffuse base: (1 - f0) (1 - z)). Texel (roughness i of [0, 1], sqrt cosine j of [0, 1]) at [j * size + i].
struct AlbedoTable {
  int size = 0;
  std::vector<glm::vec3> entries;
};

/// Deterministic; `threads` 0 means all cores.
AlbedoTable makeAlbedoTable(int size = 64, int threads = 0);

/// The table of default size, made when it is first asked for and kept while the process lives.
const AlbedoTable& sharedAlbedoTable();

/// (x, y) of AlbedoTable at one point, by quadrature over visible half vectors; error below 1e-3 for alpha >= 1e-3.
glm::dvec2 ggxAlbedo(double alpha, double cosineOut);

}  // namespace chiaro
