#include "precompute/material/material_figure.h"

#include <cmath>

#include "precompute/material/ndf_width.h"
#include "precompute/material/reconstruction_error.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

constexpr int kPoints = 160;

double degreesOf(int i) { return 0.05 * std::pow(85.0 / 0.05, static_cast<double>(i) / (kPoints - 1)); }
double radians(double degrees) { return degrees / 180.0 * lobe64::kPi; }

Curve curveOf(std::string name, int colour, bool dashed) {
  Curve curve;
  curve.name = std::move(name);
  curve.colour = colour;
  curve.dashed = dashed;
  curve.dotted = false;
  return curve;
}

/// rho (n.wi) with the half vector leaning by `half` towards the viewer.
double slice(const ReflectanceFunction& reflectance, double view, double half) {
  const double light = view - 2.0 * half;  // in the plane of incidence, the viewer's side is negative
  if (!(std::abs(light) < lobe64::kHalfPi)) return lobe64::notANumber();
  const Vec3 wo(-std::sin(view), 0.0, std::cos(view)), wi(std::sin(light), 0.0, std::cos(light));
  return luminance(reflectance(wo, wi)) * wi.z;
}

Figure distributionFigure(const NdfTable& table, const MaterialStudy& study) {
  Figure figure{.id = "distribution",
                .title = study.name + ": distribution of microfacet normals",
                .xLabel = "angle from the normal, degrees",
                .yLabel = "distribution",
                .note = {},
                .logX = true,
                .logY = true,
                .curves = {}};
  const NdfWidth scaled = fitNdfWidth(study.chosen().kind, [&](double angle) { return table.at(angle); });
  const auto model = fittedNdf(study.chosen().kind, study.chosen().fit.width);
  Curve data = curveOf("given", 0, false), fit = curveOf(modelJsonName(study.chosen().kind), 1, true),
        mixture = curveOf(std::to_string(study.direct.lobes.size()) + " lobes", 2, true);
  for (int i = 0; i < kPoints; ++i) {
    const double degrees = degreesOf(i), angle = radians(degrees);
    double sum = 0.0;
    for (const auto& lobe : study.direct.lobes) sum += lobe64::sgEvaluate(lobe, Vec3(std::sin(angle), 0.0, std::cos(angle)));
    const double values[] = {table.at(angle), scaled.scale * model(angle), sum};
    Curve* curves[] = {&data, &fit, &mixture};
    for (std::size_t c = 0; c < 3; ++c) curves[c]->x.push_back(degrees), curves[c]->y.push_back(values[c]);
  }
  figure.curves = {data, fit, mixture};
  return figure;
}

}  // namespace

Figure materialFigure(const MaterialData& data, const MaterialStudy& study) {
  if (data.ndf) return distributionFigure(*data.ndf, study);
  Figure figure{.id = "material",
                .title = study.name + ": data and " + modelJsonName(study.chosen().kind),
                .xLabel = "half vector from the normal, degrees",
                .yLabel = "luminance of rho cos, 1/sr",
                .note = "In the plane of incidence, half vectors leaning towards the viewer. Lines: data. Dashed: fit.",
                .logX = true,
                .logY = true,
                .curves = {}};
  const ReflectanceFunction fit = studiedReflectance(study);
  int colour = 0;
  for (const int view : {0, 30, 60, 75}) {
    Curve truth = curveOf("data, " + std::to_string(view) + " deg", colour, false),
          model = curveOf("fit, " + std::to_string(view) + " deg", colour, true);
    for (int i = 0; i < kPoints; ++i) {
      const double degrees = degreesOf(i);
      truth.x.push_back(degrees), truth.y.push_back(slice(data.reflectance, radians(view), radians(degrees)));
      model.x.push_back(degrees), model.y.push_back(slice(fit, radians(view), radians(degrees)));
    }
    figure.curves.push_back(std::move(truth));
    figure.curves.push_back(std::move(model));
    ++colour;
  }
  return figure;
}

}  // namespace chiaro
