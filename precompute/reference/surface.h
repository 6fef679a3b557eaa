#pragma once
/// What a ray met, with its material looked up: everything that shading needs and nothing about light.

#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "assets/scene/scene.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/reference/brdf.h"
#include "precompute/reference/texture_sampler.h"

namespace chiaro::reference {

/// World space, unit vectors, metres. All normals are on the side that is seen.
struct Surface {
  glm::dvec3 position{0.0};
  glm::dvec3 geometricNormal{0.0, 1.0, 0.0};
  glm::dvec3 interpolatedNormal{0.0, 1.0, 0.0};  ///< of the mesh, before any normal map
  glm::dmat3 worldFromTangent{1.0};  ///< columns: tangent of the anisotropy, bitangent, shading normal (all three orthonormal)
  Brdf brdf;
  glm::dvec3 emission{0.0};
  double opacity = 1.0;  ///< below 1 for alpha-blended materials only
};

/// Reads surfaces of one scene. Thread safe once made.
class SurfaceReader {
 public:
  /// Decodes every texture a material uses; keeps a reference to `scene`. Throws Error (unreadableInput).
  /// `energyCompensation`: GGX gives back what scatters more than once between its facets (multipleScatteringGain).
  explicit SurfaceReader(const Scene& scene, bool energyCompensation = false);

  /// True where a viewer looking along `direction` sees the back of a material that has none (glTF 2.0, 3.9.6: culled).
  bool isCulled(const RayHit& hit, glm::vec3 direction) const;

  /// `wo`: unit, towards the viewer. The shading normal is the normal-mapped one, negated with the others on the back of a
  /// double-sided material, then bent by shadingNormalTowards(); anisotropy's tangent is made perpendicular to it.
  Surface at(const RayHit& hit, glm::dvec3 wo) const;

 private:
  /// RGBA of a texture, or white without one.
  glm::dvec4 lookUp(int texture, const TextureTransform& transform, TextureEncoding encoding, glm::vec2 texcoord) const;

  void readBrdf(const Material& material, glm::vec2 texcoord, double anisotropy, Surface& surface) const;

  const Scene* scene_;
  bool energyCompensation_ = false;
  std::map<std::pair<int, TextureEncoding>, TextureSampler> textures_;
};

}  // namespace chiaro::reference
