#include "precompute/material/material_study.h"

#include "precompute/material/ndf_width.h"
#include "precompute/material/reconstruction_error.h"
#include "precompute/parallel.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

void studyDistribution(const NdfTable& table, const MaterialOptions& options, MaterialStudy& study) {
  const auto ndf = [&](double angle) { return table.at(angle); };
  study.pairs = table.angle.size();
  study.direct = fitNdfMixture(ndf, options.lobes);
  for (const int kind : options.models) {
    const NdfWidth width = fitNdfWidth(kind, ndf);
    ModelFit one{.kind = kind, .fit = {}, .mixture = fitNdfMixture(fittedNdf(kind, width.width), options.lobes)};
    one.fit.width = one.fit.width2 = width.width;
    one.fit.specular = Vec3(1.0);
    one.fit.error = width.error;
    study.models.push_back(std::move(one));
  }
}

}  // namespace

MaterialStudy studyMaterial(const MaterialData& data, const MaterialOptions& options) {
  MaterialStudy study;
  study.name = data.name;
  study.form = data.form;
  if (data.ndf) {
    studyDistribution(*data.ndf, options, study);
  } else {
    const auto samples = fitSamples(data.reflectance, kWidestMeasured, options.grid, data.name);
    const auto fine = fitSamples(data.reflectance, kWidestMeasured, options.errorGrid, data.name);
    study.pairs = samples.size();
    study.models.resize(options.models.size());
    parallelBlocks(options.threads, options.models.size(), [&](std::size_t i) {
      const int kind = options.models[i];
      const FitFamily family = modelFamily(kind);
      ModelFit& one = study.models[i];
      one.kind = kind;
      one.fit = fitMaterial(samples, family, options.fit);
      one.error = reconstructionError(fine, fittedReflectance(family, one.fit));
      const auto first = fittedNdf(kind, one.fit.width), second = fittedNdf(kind, one.fit.width2);
      // Both lobes are normalised by their widths; the first one's smooth factor stands for both.
      const double part = one.fit.share * one.fit.width * one.fit.width / (one.fit.width2 * one.fit.width2);
      one.mixture =
          fitNdfMixture([&](double angle) { return (1.0 - one.fit.share) * first(angle) + part * second(angle); }, options.lobes);
      one.mixtureError = reconstructionError(fine, mixtureReflectance(kind, one.fit, one.mixture, LobeWarp::none));
      one.isotropicError = reconstructionError(fine, mixtureReflectance(kind, one.fit, one.mixture, LobeWarp::isotropic));
      one.chosenError = reconstructionError(fine, mixtureReflectance(kind, one.fit, one.mixture, LobeWarp::chosen));
    });
  }
  for (std::size_t i = 1; i < study.models.size(); ++i)
    if (study.models[i].fit.error < study.models[study.best].fit.error) study.best = i;
  return study;
}

ReflectanceFunction studiedReflectance(const MaterialStudy& study) {
  return fittedReflectance(modelFamily(study.chosen().kind), study.chosen().fit);
}

}  // namespace chiaro
