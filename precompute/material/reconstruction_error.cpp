#include "precompute/material/reconstruction_error.h"

#include <cmath>

namespace chiaro {
namespace {

using lobe64::Vec3;

lobe64::ReflectanceModel modelOf(int kind, double width) {
  const double x = modelFamily(kind).published(width);
  return lobe64::reflectanceModel(kind, x, x);
}

double lobeSum(const NdfMixture& mixture, const Vec3& wo, const Vec3& wi, LobeWarp warp) {
  double sum = 0.0;
  for (const auto& lobe : mixture.lobes) {
    if (warp == LobeWarp::none) {
      sum += lobe64::sgEvaluate(lobe, lobe64::halfVector(wo, wi));
      continue;
    }
    const int way = warp == LobeWarp::isotropic ? lobe64::kWarpIsotropic
                                                : lobe64::warpChoice(lobe.sharpness, lobe64::warpCosine(wo, lobe.axis), true);
    const int count = lobe64::warpLobeCount(way);
    for (int k = 0; k < count; ++k) sum += lobe64::sgEvaluate(lobe64::sgWarpLobe(lobe, wo, count, k), wi);
  }
  return sum;
}

}  // namespace

double reconstructionError(const std::vector<FitSample>& samples, const ReflectanceFunction& reconstruction) {
  double error2 = 0.0, norm2 = 0.0;
  for (const FitSample& s : samples) {
    const double truth = luminance(s.rho) * s.wi.z * s.wo.z,
                 difference = luminance(reconstruction(s.wo, s.wi)) * s.wi.z * s.wo.z - truth;
    error2 += s.weight * difference * difference;
    norm2 += s.weight * truth * truth;
  }
  return error2 / norm2;
}

ReflectanceFunction mixtureReflectance(int kind, const MaterialFit& fit, const NdfMixture& mixture, LobeWarp warp) {
  const auto model = modelOf(kind, fit.width);
  FitFamily family{
      .name = modelJsonName(kind),
      .fresnel = FitFamily::Fresnel::schlick,
      .lobe = [=](double, const Vec3& wo,
                  const Vec3& wi) { return lobeSum(mixture, wo, wi, warp) * lobe64::smoothTimesCosine(model, wo, wi) / wi.z; },
      .published = {}};
  MaterialFit one = fit;
  one.share = 0.0;
  return fittedReflectance(family, one);
}

std::function<double(double)> fittedNdf(int kind, double width) {
  const auto model = modelOf(kind, width);
  return [model](double angle) { return lobe64::ndfValue(model, Vec3(std::sin(angle), 0.0, std::cos(angle))); };
}

}  // namespace chiaro
