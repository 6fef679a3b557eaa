#pragma once
/// Measured materials for `chiaro-report brdf --measured`: fits, errors of their spherical Gaussians, and Ngan's published parameters beside refits.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "precompute/figure/figure.h"
#include "precompute/material/material_study.h"

namespace chiaro {

/// One material of one source, the best of all models. Errors are equation (11) of luminances, both directions up to 80 degrees; NaN where not
/// measured.
struct MeasuredMaterial {
  std::string file, name;
  MaterialForm form = MaterialForm::merl;
  ModelFit best;
  double
      cosineModel = 0.0,
      cosineMixture =
          0.0;  ///< the best model by FitMetric::cosine, as Ngan et al. and the supplement fit, and its lobes; NaN as the factorisations are
  double ours = 0.0;  ///< what a shader reads (reflectance_table.h); NaN for Ashikhmin-Shirley, which has no table
  double factored16 = 0.0, factored64 = 0.0, factored256 = 0.0;  ///< NaN in tables, for materials that Ngan did not fit
  bool resolved = true;  ///< by the grid of the factorisations; else their true errors are larger still
};

/// One family of Ngan's, fitted anew to a reconstruction of the material that it was published for, by their metric.
struct NganRefit {
  std::string material, family, source;          ///< source: MERL, SGD or ABC
  double width = 0.0, publishedWidth = 0.0;      ///< m, ax or exponent
  double peak = 0.0, publishedPeak = 0.0;        ///< red specular reflectance at normal incidence, 1/sr
  double diffuse = 0.0, publishedDiffuse = 0.0;  ///< red
  double error = 0.0,
         publishedError = 0.0;  ///< root mean square of rho cos, of this fit, and of the published parameters, on this source
};

struct MeasuredStudy {
  std::vector<MeasuredMaterial> materials;
  std::vector<NganRefit> refits;
  std::vector<Figure> figures;
  bool empty() const { return materials.empty(); }
};

/// Files to measure: those named, and in folders every .binary, .binary.xz and .csv with a column "material". Sorted. Throws Error
/// (unreadableInput) where a path leads to none.
std::vector<std::filesystem::path> measuredFiles(const std::vector<std::filesystem::path>& paths);

/// quick: six rows of each table. Deterministic whatever `threads`.
MeasuredStudy studyMeasured(const std::vector<std::filesystem::path>& files, bool quick, int threads,
                            const std::function<void(const std::string&, double)>& progress);

}  // namespace chiaro
