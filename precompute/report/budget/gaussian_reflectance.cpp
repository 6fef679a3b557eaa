#include "precompute/report/budget/gaussian_reflectance.h"

#include <cmath>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr int kGaussians = 4;  // the most that shaders/lobe/ggx.glsl fits

}  // namespace

double gaussianOverExact(const reference::Brdf& brdf, glm::dvec3 wo, glm::dvec3 wi) {
  if (brdf.model != Reflectance::ggx || brdf.alphaX != brdf.alphaY) return 1.0;
  const double rough = lobe64::roughReflectionShare(lobe64::kGgx, brdf.alphaX);
  if (rough >= 1.0) return 1.0;
  const auto wh = lobe64::halfVector(wo, wi);
  const double exact = lobe64::ndfValue(lobe64::reflectanceModel(lobe64::kGgx, brdf.alphaX, brdf.alphaX), wh);
  if (!(exact > 0.0)) return 1.0;
  double mixture = 0.0;
  for (int k = 0; k < kGaussians; ++k) {
    const auto lobe = lobe64::ggxMixtureLobe(brdf.alphaX, kGaussians, k);
    // 1 - wh.z without cancellation
    mixture += lobe.x * std::exp(-lobe.y * (wh.x * wh.x + wh.y * wh.y) / (1.0 + wh.z));
  }
  return rough + (1.0 - rough) * mixture / exact;
}

}  // namespace chiaro
