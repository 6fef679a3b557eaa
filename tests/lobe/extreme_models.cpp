#include "tests/lobe/extreme_models.h"

#include <cmath>
#include <random>

namespace chiaro::parity {

Case extremeModels() {
  Case c;
  c.name = "modelRadiance";
  c.inputCount = 11;
  c.outputCount = 3;
  c.run32 = lobe32::kernel_modelRadiance;
  c.run64 = lobe64::kernel_modelRadiance;
  std::mt19937_64 engine(11);
  const auto unit = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  const auto atEnds = [&] { return unit() < 0.3 ? std::round(unit()) : unit(); };
  const auto direction = [&] {
    const double z = 2.0 * unit() - 1.0, phi = 6.283185307179586 * unit(), r = std::sqrt(1.0 - z * z);
    glm::dvec3 w(r * std::cos(phi), r * std::sin(phi), z);
    const double kind = unit();
    if (kind < 0.3) w.z *= std::pow(10.0, -8.0 * unit());                      // grazing, above or below
    else if (kind < 0.5) w = glm::dvec3(1e-4 * w.x, 1e-4 * w.y, 1.0);  // next to the normal
    return glm::vec3(glm::normalize(w));
  };
  for (int i = 0; i < 1'000'000; ++i) {
    const int kind = i % lobe64::kModelCount;
    c.inputs.push_back(static_cast<float>(kind));
    for (int k = 0; k < 2; ++k) c.inputs.push_back(static_cast<float>(lobe64::modelHasExponent(kind) ? std::pow(10.0, 6.0 * atEnds()) : std::pow(10.0, -4.0 * atEnds())));
    // Half of the lights stand where the mirror image of the viewer does, or next to it.
    const glm::vec3 wo = direction(), wi = unit() < 0.5 ? glm::vec3(-wo.x, -wo.y, wo.z) : direction();
    c.inputs.insert(c.inputs.end(), {wo.x, wo.y, wo.z, wi.x, wi.y, wi.z, static_cast<float>(atEnds()), static_cast<float>(std::pow(10.0, 12.0 * atEnds() - 6.0))});
  }
  return c;
}

}  // namespace chiaro::parity
