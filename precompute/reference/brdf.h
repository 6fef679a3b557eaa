#pragma once
/// The glTF 2.0 metallic-roughness BRDF (specification, appendix B) with KHR_materials_anisotropy, and ways to sample it. Written apart
/// from shaders/lobe on purpose: each is the other's check. Double precision.
///
///   f = F D G / (4 (n.wi) (n.wo)) + (1 - F) diffuse / pi,   F = f0 + (f90 - f0)(1 - wo.wh)^5
///
/// D: anisotropic GGX (Burley, Physically-Based Shading at Disney, 2012, eq. 13). G: height-correlated Smith (Heitz, Understanding the
/// Masking-Shadowing Function, JCGT 3(2), 2014, eq. 99 and 87). Vectors are unit, in the tangent frame (x tangent, y bitangent, z normal).

#include <glm/glm.hpp>

namespace chiaro::reference {

/// Roughness below this is taken as this: a lobe far narrower than a texel of any environment.
inline constexpr double kMinAlpha = 1e-4;

struct Brdf {
  glm::dvec3 diffuse{0.0};  ///< diffuse albedo: base colour * (1 - metallic)
  glm::dvec3 f0{0.04};      ///< reflectance at normal incidence
  glm::dvec3 f90{1.0};      ///< and at grazing incidence: always 1 in glTF; f0 = f90 = 0 is Lambert's surface
  double alphaX = 0.25;     ///< GGX width along the tangent, at least kMinAlpha
  double alphaY = 0.25;     ///< and along the bitangent
};

/// f * wi.z, per steradian; 0 where wi.z <= 0 or wo.z <= 0.
glm::dvec3 brdfTimesCosine(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

/// Direction of cosine density over the hemisphere, and its density wi.z / pi.
glm::dvec3 sampleCosine(glm::dvec2 random);
double cosineDensity(glm::dvec3 wi);

/// The reflection of wo at a visible normal (Heitz, Sampling the GGX Distribution of Visible Normals, JCGT 7(4), 2018). May lie below
/// the horizon.
glm::dvec3 sampleReflection(const Brdf& brdf, glm::dvec3 wo, glm::dvec2 random);
/// Its density over wi: G1(wo) D(wh) / (4 wo.z).
double reflectionDensity(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

/// A good share of samples for the reflection (the rest for the cosine), in [0,1].
double reflectionShare(const Brdf& brdf, glm::dvec3 wo);

}  // namespace chiaro::reference
