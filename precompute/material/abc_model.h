#pragma once
/// The ABC microfacet model (Low, Kronander, Ynnerman, Unger, BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces, 2012, eq. 14
/// to 16):
///   rho = kD / pi + F G D / (pi (n.wi) (n.wo)),  D = A / (1 + B (1 - n.wh))^C
/// F: of an unpolarised dielectric of index `ior`; G: the groove masking of Cook and Torrance.

#include "precompute/material/measured_reflectance.h"

namespace chiaro {

struct AbcModel {
  lobe64::Vec3 diffuse{0.0}, a{0.0};
  double b = 0.0, c = 0.0;
  double ior = 1.5;  ///< > 0
};

ReflectanceFunction abcReflectance(const AbcModel& model);

/// Fresnel's equations for unpolarised light, cosine in [0, 1]; 1 at total reflection.
double dielectricFresnel(double cosine, double ior);

/// min(1, 2 (n.wh) (n.wo) / (wo.wh), 2 (n.wh) (n.wi) / (wo.wh)), both directions above the surface.
double grooveMasking(const lobe64::Vec3& wo, const lobe64::Vec3& wi, const lobe64::Vec3& wh);

}  // namespace chiaro
