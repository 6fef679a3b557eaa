#pragma once
/// The analytic models that Ngan, Durand and Matusik fitted to the MERL materials (Experimental Analysis of BRDF Models, 2005), as their
/// parameters are tabulated: a Lambertian part scale / pi and lobes scale S, with c = n.wh, F = F0 + (1 - F0) (1 - wo.wh)^5, G the groove
/// masking:
///   Ward            e^(-tan^2 / ax^2) / (4 pi ax^2 sqrt((n.wi) (n.wo)))       (Ward 1992)
///   WardDuer        the same over (n.wi) (n.wo)                               (Duer 2004)
///   BlinnPhong      (Exponent + 2) / (2 pi) c^Exponent
///   LafortuneIso    (Cxy (x x' + y y') + Cz z z')^Exponent, where positive     (Lafortune 1997)
///   CookTorrance    F G e^(-tan^2 / m^2) / (4 pi m^2 c^4 (n.wi) (n.wo))
///   AshikhminShirley  (Exponent + 1) / (8 pi) c^Exponent F / ((wo.wh) max(n.wi, n.wo))
/// BRDFLab, where the table comes from, has 1/pi for CookTorrance; with that, peaks would be four times those of the other families and of the data.

#include <string>
#include <vector>

#include "precompute/material/measured_reflectance.h"

namespace chiaro {

enum class NganFamily { ward, wardDuer, blinnPhong, lafortune, cookTorrance, ashikhminShirley };
const char* nganName(NganFamily family);

struct NganLobe {
  NganFamily family = NganFamily::ward;
  lobe64::Vec3 scale{0.0};
  double width = 0.1;  ///< ax, m or Exponent
  double f0 = 1.0;     ///< CookTorrance and AshikhminShirley
  double cxy = -1.0, cz = 1.0;
};

/// The lobe with scale 1, without F; both directions above the surface, else 0.
double nganLobe(const NganLobe& lobe, const lobe64::Vec3& wo, const lobe64::Vec3& wi);
inline bool nganHasFresnel(NganFamily family) {
  return family == NganFamily::cookTorrance || family == NganFamily::ashikhminShirley;
}
inline bool nganHasExponent(NganFamily family) {
  return family == NganFamily::blinnPhong || family == NganFamily::lafortune || family == NganFamily::ashikhminShirley;
}

struct NganModel {
  lobe64::Vec3 diffuse{0.0};
  std::vector<NganLobe> lobes;
};

ReflectanceFunction nganReflectance(const NganModel& model);

/// Reads `Lambertian scale=(r,g,b) | CookTorrance scale=(r,g,b) m=.. F0=.. | ...`. Throws Error (unreadableInput) with `where` and `line`.
NganModel parseNganModel(const std::string& text, const std::string& where, std::size_t line);

}  // namespace chiaro
