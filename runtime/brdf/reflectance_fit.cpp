#include "runtime/brdf/reflectance_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "runtime/brdf/albedo_table.h"
#include "runtime/brdf/slice_fit.h"
#include "runtime/parallel.h"

namespace chiaro {
namespace {

using Eigen::VectorXd;
using lobe64::Vec3;
using slice::Lobe;
using slice::Shape;
using slice::Slice;

constexpr double kLeastCosine = 0.03;  // grazing views below 88 degrees are taken as that

double widthAt(int i, int count) {
  const double least = std::sqrt(lobe64::kMinTableWidth), most = std::sqrt(lobe64::kMaxTableWidth);
  return std::pow(least + (most - least) * i / (count - 1), 2);
}
double cosineAt(int j, int count) { return std::max(std::pow(static_cast<double>(j) / (count - 1), 2), kLeastCosine); }
double parameterOf(int kind, double width) {
  return lobe64::modelHasExponent(kind) ? std::max(2.0 / (width * width) - 1.0, 1.0) : width;
}

Shape shapeOf(int kind) { return {lobe64::reflectanceSingles(kind), lobe64::reflectancePairs(kind)}; }

// By trial, as PSNR of an unoccluded sphere under bright windows and suns: with equation (11)'s even weights GGX has 5 to 10 dB less, others 3.
slice::Weighting weightingOf(int kind) { return kind == lobe64::kGgx ? slice::Weighting{1e-4, 1.0} : slice::Weighting{1e-3, 0.5}; }

// Of a neighbour: far below the errors fitted, enough to keep idle lobes in place. These pulls and the view that a table starts from were found by
// trial: with others some neighbours come to share out the work differently, and what lies between them suffers (by up to .3 in equation (11)).
double pullOf(int kind) { return kind == lobe64::kGgx ? 3e-5 : 1e-3; }
double startOf(int kind) { return (kind == lobe64::kGgx ? 14.0 : 18.0) / 24.0; }
constexpr double kSweepPull = 3e-4;
constexpr int kSteps = 40, kSweeps = 6;

/// GGX's weights bring its exact albedo, so that a white furnace is white.
void scaleToAlbedo(std::vector<glm::dvec2>& weights, double alpha, double cosineOut) {
  glm::dvec2 sum(0.0);
  for (const glm::dvec2& w : weights) sum += w;
  const glm::dvec2 albedo = ggxAlbedo(alpha, cosineOut);
  for (glm::dvec2& w : weights)
    for (int c = 0; c < 2; ++c) w[c] *= sum[c] > 0.0 ? albedo[c] / sum[c] : 0.0;
}

}  // namespace

ReflectanceTable makeReflectanceTable(int kind, int widthCount, int cosineCount, int threads) {
  ReflectanceTable table{kind, widthCount, cosineCount, {}};
  const int layer = widthCount * cosineCount;
  table.entries.resize(static_cast<std::size_t>(layer) * static_cast<std::size_t>(lobe64::reflectanceEntries(kind)));
  const Shape shape = shapeOf(kind);
  const auto sliceAt = [&](int i, int j) {
    return slice::sampleSlice(kind, parameterOf(kind, widthAt(i, widthCount)), cosineAt(j, cosineCount), weightingOf(kind));
  };

  const auto store = [&](int i, int j, const Slice& slice, const VectorXd& p) {
    auto weights = slice::splitWeights(shape, slice, p);
    if (kind == lobe64::kGgx) scaleToAlbedo(weights, slice.width, cosineAt(j, cosineCount));
    const auto entry = [&](int k) -> glm::vec4& {
      return table.entries[static_cast<std::size_t>((k * cosineCount + j) * widthCount + i)];
    };
    glm::vec4 elevations(0.0f);
    for (int g = 0; g < shape.groups(); ++g) {
      const Lobe lobe = slice::lobeOf(shape, slice, p, g);
      const double each = g < shape.singles ? 1.0 : 0.5;
      const glm::dvec2 weight = weights[static_cast<std::size_t>(g)] * each;
      entry(g) = glm::vec4(glm::dvec4(p[shape.first(g)], std::log2(lobe.sharpness * slice.width * slice.width), weight));
      if (g >= shape.singles) elevations[g - shape.singles] = static_cast<float>(lobe.elevation / slice.width);
    }
    entry(shape.groups()) = elevations;
  };

  std::vector<VectorXd> fitted(static_cast<std::size_t>(layer));
  const auto at = [&](int i, int j) -> VectorXd& { return fitted[static_cast<std::size_t>(j * widthCount + i)]; };
  const auto fit = [&](int i, int j, const VectorXd& prior, double pull) {
    at(i, j) = prior;
    slice::refine(shape, sliceAt(i, j), at(i, j), prior, pull, kSteps);
  };
  // From one well-conditioned view of the sharpest row, each texel from its neighbours in the row before and in its own, so that the same
  // lobe does the same work everywhere and entries interpolate. The two halves of a row are independent.
  const int start = static_cast<int>(std::lround(startOf(kind) * (cosineCount - 1)));
  double ignored = 0.0;
  const VectorXd first = slice::fitFromNothing(shape, sliceAt(0, start), ignored);
  for (int i = 0; i < widthCount; ++i) {
    fit(i, start, i == 0 ? first : at(i - 1, start), pullOf(kind));
    parallelFor(2, threads, [&](int half) {
      const int step = half == 0 ? -1 : 1;
      for (int j = start + step; j >= 0 && j < cosineCount; j += step)
        fit(i, j, i == 0 ? at(i, j - step) : VectorXd(0.5 * (at(i, j - step) + at(i - 1, j))), pullOf(kind));
    });
  }
  // Then each anew from the mean of its neighbours, as on a chessboard: what a march got stuck in is left, and what lies between texels gains.
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int colour = 0; colour < 2; ++colour)
      parallelFor(layer, threads, [&](int texel) {
        const int i = texel % widthCount, j = texel / widthCount;
        if ((i + j) % 2 != colour) return;
        VectorXd mean = VectorXd::Zero(shape.size());
        int count = 0;
        for (const auto& [di, dj] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          if (i + di < 0 || i + di >= widthCount || j + dj < 0 || j + dj >= cosineCount) continue;
          mean += at(i + di, j + dj);
          ++count;
        }
        fit(i, j, mean / count, kSweepPull);
      });
  parallelFor(layer, threads, [&](int texel) {
    const int i = texel % widthCount, j = texel / widthCount;
    store(i, j, sliceAt(i, j), at(i, j));
  });
  return table;
}

std::vector<SliceLobe> fitSliceLobes(int kind, double parameter, double cosineOut, int count) {
  const Shape shape{count, 0};
  const Slice slice = slice::sampleSlice(kind, parameter, cosineOut);
  double error = 0.0;
  const VectorXd p = slice::fitFromNothing(shape, slice, error);
  std::vector<SliceLobe> lobes;
  for (int g = 0; g < count; ++g) {
    const Lobe lobe = slice::lobeOf(shape, slice, p, g);
    lobes.push_back({slice::axisOf(lobe, 1.0), lobe.sharpness, lobe.amplitude * lobe64::sgUnitIntegral(lobe.sharpness), 0.0});
  }
  return lobes;
}

}  // namespace chiaro
