#include "precompute/report/visibility/supplement_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "precompute/report/visibility/haar_method.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/report/visibility/product_error.h"
#include "precompute/report/visibility/sh_method.h"

namespace chiaro {
namespace {

constexpr int kBands[] = {4, 5, 7, 10};  // of spherical harmonics: their squares are terms
constexpr double kShown[] = {10.0, 100.0, 1000.0};

std::vector<int> termCounts() {
  std::vector<int> counts;
  for (const int bands : kBands) counts.push_back(bands * bands);
  return counts;
}

Figure productFigure(const VisibilityStudy& study, const TracedVertices& traced, const VisibilitySettings& settings, const ProgressHandler& progress) {
  const auto& input = study.input();
  const auto paper = makeUncompressedMethod(input, traced, ssdfWithHorizon()), ours = makeUncompressedMethod(input, traced, ssdfOfOccluders());
  const std::function<void(double)> shown = [&](double done) {
    if (progress) progress("products", done);
  };
  const auto errors = productErrors(input.rays, study.points(), {paper.get(), ours.get()}, settings.rays / 2, settings.seed, settings.threads, shown);
  Figure figure{.id = "product",
                .title = "Products with a signed distance (supplement, figure 7)",
                .xLabel = "sharpness of the lobe",
                .yLabel = "squared error, relative",
                .note = "Visibility as a half-space at the distance to its nearest edge, not compressed. Inner: the lobe's integral. Vector: a lobe of the same shape in place of the product; "
                        "what is left of that with the true share is what no share can mend.",
                .logX = true,
                .logY = true,
                .curves = {}};
  const auto& x = productSharpness();
  figure.curves.push_back({.name = "inner, Wang et al.", .x = x, .y = errors[0].inner, .colour = 0});
  figure.curves.push_back({.name = "inner, horizon apart", .x = x, .y = errors[1].inner, .colour = 2});
  figure.curves.push_back({.name = "vector, Wang et al.", .x = x, .y = errors[0].vector, .dashed = true, .colour = 0});
  figure.curves.push_back({.name = "vector, horizon apart", .x = x, .y = errors[1].vector, .dashed = true, .colour = 2});
  figure.curves.push_back({.name = "vector, true share", .x = x, .y = errors[2].vector, .dashed = true, .colour = 7});
  return figure;
}

struct Family {
  std::string name;
  std::vector<MethodError> byTerms;
};

std::vector<Family> families(const VisibilityStudy& study, const TracedVertices& traced, const ProgressHandler& progress) {
  const auto measured = [&](const std::string& name, const std::vector<std::unique_ptr<VisibilityMethod>>& methods) {
    std::vector<const VisibilityMethod*> asked;
    for (const auto& method : methods) asked.push_back(method.get());
    return Family{name, study.errorsOf(asked, progress)};
  };
  if (progress) progress("terms", 0.0);
  std::vector<std::unique_ptr<VisibilityMethod>> distances;
  for (const int terms : termCounts()) {
    VisibilityInput input = study.input();
    input.terms = terms;
    distances.push_back(makePcaMethod(input, traced, ssdfWithHorizon()));
  }
  return {measured("SSDF PCA", distances), measured("Haar wavelets", makeHaarMethods(study.input(), termCounts())),
          measured("spherical harmonics", makeShMethods(study.input(), {std::begin(kBands), std::end(kBands)}))};
}

Figure termsFigure(const std::vector<Family>& all, double sharpness, bool atVertices) {
  char text[120];
  std::snprintf(text, sizeof text, "Equal numbers of terms, sharpness %g, %s (supplement, figure 10)", sharpness, atVertices ? "at vertices" : "inside triangles");
  Figure figure{.id = "", .title = text, .xLabel = "terms a vertex", .yLabel = "mean |error|", .note = "", .logX = false, .logY = true, .curves = {}};
  figure.note = "Of the visible fraction of a lobe. A wavelet also stores which one it is.";
  std::snprintf(text, sizeof text, "terms_%s_%g", atVertices ? "vertices" : "triangles", sharpness);
  figure.id = text;
  const auto s = static_cast<std::size_t>(std::find(kLobeSharpness.begin(), kLobeSharpness.end(), sharpness) - kLobeSharpness.begin());
  const auto counts = termCounts();
  for (std::size_t f = 0; f < all.size(); ++f) {
    Curve curve{.name = all[f].name, .x = {counts.begin(), counts.end()}, .y = {}, .dashed = f > 0};
    for (const auto& error : all[f].byTerms) curve.y.push_back((atVertices ? error.atVertices : error.inTriangles)[s]);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

}  // namespace

std::vector<Figure> supplementFigures(const VisibilityStudy& study, const VisibilitySettings& settings, const ProgressHandler& progress) {
  const OctahedralGrid grid(study.input().resolution);
  const TracedVertices traced(study.input(), grid);
  std::vector<Figure> figures{productFigure(study, traced, settings, progress)};
  const auto all = families(study, traced, progress);
  const auto facts = study.facts();
  for (const auto& [place, points] : {std::pair{true, facts.pointsAtVertices}, std::pair{false, facts.pointsInTriangles}})
    if (points > 0)
      for (const double sharpness : kShown) figures.push_back(termsFigure(all, sharpness, place));
  return figures;
}

}  // namespace chiaro
