#pragma once
/// From a material's data to all that is said of it: fits of the models that were asked for, mixtures, errors.

#include <string>
#include <vector>

#include "precompute/material/material_file.h"
#include "precompute/material/material_fit.h"
#include "precompute/material/ndf_mixture.h"

namespace chiaro {

/// Directions further than this from the normal are left out: measurements are not to be trusted there (Ngan et al. 2005).
inline constexpr double kWidestMeasured = 80.0 / 180.0 * 3.14159265358979323846;

struct MaterialOptions {
  std::vector<int> models;  ///< kCookTorrance ...; of several the one of least error is taken
  int lobes = 3;            ///< spherical Gaussians of the distribution, 1..4
  FitOptions fit;
  FitGrid grid;  ///< of the fit
  FitGrid errorGrid{.thetaDiff = 45, .phiDiff = 36};
  int threads = 0;  ///< never changes a figure
};

/// One model's fit. Squared errors are equation (11) of luminances, both directions up to kWidestMeasured.
struct ModelFit {
  int kind = 0;
  MaterialFit fit;              ///< for a distribution alone: its width, and error relative to the distribution
  NdfMixture mixture;           ///< of the distribution with peak 1 at the normal
  double error = 0.0;           ///< equation (11), of the model itself
  double mixtureError = 0.0;    ///< with the mixture in its place, at half vectors
  double isotropicError = 0.0;  ///< warped by the paper's rule
  double chosenError = 0.0;     ///< warped by the chosen rule
};

struct MaterialStudy {
  std::string name;
  MaterialForm form = MaterialForm::merl;
  std::size_t pairs = 0;         ///< of directions that were fitted
  std::vector<ModelFit> models;  ///< in the order asked for
  std::size_t best = 0;          ///< of `models`: the least error of the metric
  NdfMixture direct;             ///< for a distribution alone: its own mixture

  const ModelFit& chosen() const { return models[best]; }
};

/// Throws Error (unreadableInput) where the data are too few to fit.
MaterialStudy studyMaterial(const MaterialData& data, const MaterialOptions& options);

/// The chosen model as a function; for a distribution alone, with F = 1 and no diffuse part.
ReflectanceFunction studiedReflectance(const MaterialStudy& study);

}  // namespace chiaro
