#pragma once
/// The figures of the comparison for people and machines.

#include <string>
#include <vector>

#include "precompute/figure/figure.h"
#include "precompute/report/visibility/visibility_comparison.h"

namespace chiaro {

struct SceneComparison {
  std::string scene;  ///< as the user named it
  bool ground = false;
  double seconds = 0.0;
  VisibilityComparison comparison;
  std::vector<Figure> figures;  ///< supplementFigures(), where asked for
};

/// Two tables of methods by sharpness: at vertices, inside triangles.
std::string visibilityTable(const SceneComparison& scene);

/// Field names: docs/programs.md. Figures that are not defined are null.
std::string visibilityJson(const std::vector<SceneComparison>& scenes, const VisibilitySettings& settings,
                           const std::string& version);

/// One line for each scene, place and method.
std::string visibilityCsv(const std::vector<SceneComparison>& scenes);

/// The same lines as figuresCsv(), after the scene; empty where no figure was asked for.
std::string visibilityFiguresCsv(const std::vector<SceneComparison>& scenes);

}  // namespace chiaro
