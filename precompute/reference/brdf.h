#pragma once
/// The reflectance of a surface, and ways to sample it. Written apart from shaders/lobe on purpose: each is the other's check. Double
/// precision. Vectors are unit, in the tangent frame (x tangent, y bitangent, z normal).
///
///   f = (1 - coat) (sheen R_sheen + (1 - max sheen E(wo)) (F gain R + (1 - max F) diffuse / pi)) + coat R_coat,   F = f0 + (f90 - f0)(1 - wo.wh)^5
///
/// (glTF 2.0, appendix B; KHR_materials_specular, _clearcoat, _sheen: Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, 2017; E is the albedo
/// of R_sheen). R of GGX is D G / (4 (n.wi)(n.wo)): D anisotropic (Burley, Physically-Based
/// Shading at Disney, 2012, eq. 13), G height-correlated Smith (Heitz, Understanding the Masking-Shadowing Function, JCGT 3(2), 2014, eq. 99
/// and 87). Others: Cook and Torrance 1982 with a Gaussian of the angle and groove masking; Beckmann's distribution with its Smith masking;
/// Blinn-Phong and Ward normalised as in Wang et al. 2009; Ashikhmin and Shirley 2000, eq. 3.

#include <glm/glm.hpp>

#include "assets/scene/reflectance.h"

namespace chiaro::reference {

/// Roughness below this is taken as this: a lobe far narrower than a texel of any environment.
inline constexpr double kMinAlpha = 1e-4;
/// Fuzz smoother than perceptual .07 is taken as that: it would only be a rim below a pixel.
inline constexpr double kMinSheenAlpha = 0.0049;

struct Brdf {
  glm::dvec3 diffuse{0.0};  ///< diffuse albedo: base colour * (1 - metallic)
  glm::dvec3 f0{0.04};      ///< reflectance at normal incidence
  glm::dvec3 f90{1.0};      ///< and at grazing incidence; f0 = f90 = 0 is Lambert's surface
  double alphaX = 0.25;     ///< width along the tangent, at least kMinAlpha; models of an exponent: n = 2 / alpha^2 - 2. Round models read this
  double alphaY = 0.25;     ///< and along the bitangent
  Reflectance model = Reflectance::ggx;
  glm::dvec3 gain{1.0};     ///< of the reflection, for what scatters more than once: multipleScatteringGain()
  glm::dvec3 sheen{0.0};    ///< sheen colour
  double sheenAlpha = 1.0;  ///< roughness^2, at least kMinSheenAlpha
  double sheenAlbedo = 0.0; ///< E(wo), see sheenAlbedo(); for a sheen of 0 it does not matter
  double coat = 0.0;        ///< clearcoat factor
  double coatAlpha = kMinAlpha;
  glm::dvec3 coatNormal{0.0, 0.0, 1.0};
};

/// f * wi.z, per steradian; 0 where wi or wo is below the surface (the coat's: below its own).
glm::dvec3 brdfTimesCosine(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

/// Directional albedo of a sheen of colour 1, error 2e-3.
double sheenAlbedo(double alpha, double cosineOut);

/// What the coat reflects, and takes from what lies under it: factor * Schlick's Fresnel of F0 .04 at its own normal.
double coatWeight(const Brdf& brdf, glm::dvec3 wo);

/// Direction of cosine density over the hemisphere, and its density wi.z / pi.
glm::dvec3 sampleCosine(glm::dvec2 random);
double cosineDensity(glm::dvec3 wi);

/// The reflection of wo at a microfacet: GGX by visible normals (Heitz, Sampling the GGX Distribution of Visible Normals, JCGT 7(4),
/// 2018), the others by their distribution. May lie below the horizon.
glm::dvec3 sampleReflection(const Brdf& brdf, glm::dvec3 wo, glm::dvec2 random);
/// Its density over wi; its integral over the sphere is 1.
double reflectionDensity(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

/// The same of the coat.
glm::dvec3 sampleCoat(const Brdf& brdf, glm::dvec3 wo, glm::dvec2 random);
double coatDensity(const Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi);

/// A good share of samples for the coat (0 without one), and of the others for the reflection (the rest for the cosine), in [0,1].
double coatShare(const Brdf& brdf, glm::dvec3 wo);
double reflectionShare(const Brdf& brdf, glm::dvec3 wo);

/// Directional albedo of the brdf's GGX with F = 1, by 256 visible normals; error at most 5e-3, beyond 84 degrees 1e-2.
double ggxAlbedo(const Brdf& brdf, glm::dvec3 wo);
/// 1 + f0 (1 / albedo - 1) for GGX (Turquin, Practical Multiple Scattering Compensation for Microfacet Models, 2019), 1 for other models:
/// with f0 = f90 = 1 all light comes back.
glm::dvec3 multipleScatteringGain(const Brdf& brdf, glm::dvec3 wo);

}  // namespace chiaro::reference
