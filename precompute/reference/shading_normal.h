#pragma once
/// What to do with a shading normal that a normal map, or interpolation near a silhouette, has turned away from the viewer.

#include <glm/glm.hpp>

namespace chiaro {

/// The least cosine between the shading normal and the viewer.
inline constexpr double kMinViewCosine = 1e-3;

/// `normal` as it is where dot(normal, wo) >= kMinViewCosine; else tilted towards the viewer, in the plane of the two, until it
/// nearly touches the silhouette: normalize(normal + wo (kMinViewCosine - dot(normal, wo))), whose cosine is kMinViewCosine where
/// the two were perpendicular and never less by more than one part in a million. Both unit. The runtime uses the same formula.
inline glm::dvec3 shadingNormalTowards(glm::dvec3 normal, glm::dvec3 wo) {
  const double cosine = glm::dot(normal, wo);
  return cosine >= kMinViewCosine ? normal : glm::normalize(normal + wo * (kMinViewCosine - cosine));
}

}  // namespace chiaro
