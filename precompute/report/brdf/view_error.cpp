#include "precompute/report/brdf/view_error.h"

#include <algorithm>
#include <cmath>

namespace chiaro {

using lobe64::Vec3;

SliceError sliceError(const lobe64::ReflectanceModel& model, const Vec3& wo, const Slice& slice, const Quadrature& quadrature) {
  constexpr double kLinear = 0.5;  // the radius grows linearly up to here, in widths, then in proportion
  const double wx = lobe64::modelWidth(model.kind, model.x), wy = lobe64::modelWidth(model.kind, model.y);
  const bool round = model.x == model.y && wo.y == 0.0;
  const double top = std::log1p(1e3 / std::min(1.0, std::max(wx, wy)) / kLinear), turn = round ? lobe64::kPi : lobe64::kTwoPi;
  const int azimuths = round ? quadrature.azimuths : 2 * quadrature.azimuths;
  SliceError sum;
  for (int i = 0; i < quadrature.radii; ++i) {
    const double u = (i + 0.5) / quadrature.radii * top, r = kLinear * std::expm1(u),
                 step = kLinear * std::exp(u) * top / quadrature.radii;
    for (int j = 0; j < azimuths; ++j) {
      const double phi = (j + 0.5) / azimuths * turn;
      const double x = wx * r * std::cos(phi), y = wy * r * std::sin(phi), z = 1.0 / std::sqrt(1.0 + x * x + y * y);
      const Vec3 wh(x * z, y * z, z);
      const double c = dot(wo, wh);
      if (c <= 1e-6) continue;
      const Vec3 wi = 2.0 * c * wh - wo;
      if (wi.z <= 0.0) continue;
      const double weight = 4.0 * c * wx * wy * r * step * (lobe64::kTwoPi / azimuths) * z * z * z;
      const double truth = lobe64::modelTimesCosine(model, wo, wi), difference = slice(wi) - truth;
      sum.error2 += weight * difference * difference;
      sum.norm2 += weight * truth * truth;
    }
  }
  return sum;
}

double viewError(const lobe64::ReflectanceModel& model, const Reconstruction& reconstruction, double widest,
                 const Quadrature& quadrature) {
  const GaussRule views = gaussLegendre(quadrature.views, std::cos(widest), 1.0);
  const int azimuths = model.x == model.y ? 1 : quadrature.viewAzimuths;
  double error2 = 0.0, norm2 = 0.0;
  for (std::size_t v = 0; v < views.node.size(); ++v)
    for (int a = 0; a < azimuths; ++a) {
      const double z = views.node[v], s = std::sqrt((1.0 - z) * (1.0 + z)),
                   phi = azimuths == 1 ? 0.0 : (a + 0.5) / azimuths * lobe64::kHalfPi;
      const Vec3 wo(s * std::cos(phi), s * std::sin(phi), z);
      const SliceError one = sliceError(model, wo, reconstruction(wo), quadrature);
      error2 += views.weight[v] * z * z * one.error2;
      norm2 += views.weight[v] * z * z * one.norm2;
    }
  return error2 / norm2;
}

GaussRule gaussLegendre(int count, double from, double to) {
  GaussRule rule;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(lobe64::kPi * (i + 0.75) / (count + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double before = 1.0, value = x;
      for (int k = 2; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      if (count == 1) value = x, before = 1.0;
      slope = count * (x * value - before) / (x * x - 1.0);
      const double move = value / slope;
      x -= move;
      if (std::abs(move) < 1e-15) break;
    }
    rule.node.push_back(from + 0.5 * (x + 1.0) * (to - from));
    rule.weight.push_back((to - from) / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace chiaro
