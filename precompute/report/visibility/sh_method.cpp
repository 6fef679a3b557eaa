#include "precompute/report/visibility/sh_method.h"

#include <algorithm>
#include <cmath>

#include "precompute/parallel.h"
#include "precompute/report/visibility/spherical_harmonics.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {
namespace {

/// basis(t, i): Y_i at texel t times its solid angle.
std::vector<float> weightedBasis(const OctahedralGrid& grid, int bands) {
  const auto count = static_cast<std::size_t>(bands * bands);
  std::vector<float> basis(grid.texelCount * count);
  std::vector<double> values(count);
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    evaluateSh(glm::normalize(glm::dvec3(grid.direction(t))), bands, values.data());
    for (std::size_t i = 0; i < count; ++i)
      basis[t * count + i] = static_cast<float>(values[i] * static_cast<double>(grid.solidAngle[t]));
  }
  return basis;
}

class ShMethod : public VisibilityMethod {
 public:
  /// coefficients: #encoded by `stride`.
  ShMethod(const VisibilityInput& input, int bands, const std::vector<float>& coefficients, std::size_t stride)
      : encoded_(input.encoded),
        bands_(bands),
        count_(static_cast<std::size_t>(bands * bands)),
        coefficients_(encoded_.size() * count_) {
    float scale = 0.0f;
    for (std::size_t i = 0; i < encoded_.size(); ++i)
      for (std::size_t k = 0; k < count_; ++k) scale = std::max(scale, std::abs(coefficients[i * stride + k]));
    for (std::size_t i = 0; i < encoded_.size(); ++i)
      for (std::size_t k = 0; k < count_; ++k) coefficients_[i * count_ + k] = rounded16(coefficients[i * stride + k], scale);
  }

  std::string name() const override { return "SH " + std::to_string(count_); }
  StoredBytes bytes() const override { return {2.0 * static_cast<double>(count_), 4.0}; }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<double> mixed(count_, 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const float* corner = coefficients_.data() + slotOf(encoded_, point.vertices[c]) * count_;
      for (std::size_t k = 0; k < count_; ++k) mixed[k] += static_cast<double>(point.weights[c]) * static_cast<double>(corner[k]);
    }
    return [this, mixed = std::move(mixed)](const Lobe& lobe) {
      std::vector<double> basis(count_);
      evaluateSh(lobe.axis, bands_, basis.data());
      const auto rho = lobeBands(lobe.sharpness, bands_);
      double sum = 0.0;
      for (int l = 0, k = 0; l < bands_; ++l)
        for (int m = -l; m <= l; ++m, ++k)
          sum += rho[static_cast<std::size_t>(l)] * mixed[static_cast<std::size_t>(k)] * basis[static_cast<std::size_t>(k)];
      return sum;
    };
  }

 private:
  std::vector<std::size_t> encoded_;
  int bands_;
  std::size_t count_;
  std::vector<float> coefficients_;  ///< #encoded by count, as stored
};

}  // namespace

std::vector<double> projectSh(const OctahedralGrid& grid, const std::vector<float>& values, int bands) {
  const auto count = static_cast<std::size_t>(bands * bands);
  const auto basis = weightedBasis(grid, bands);
  std::vector<double> sum(count, 0.0);
  for (std::size_t t = 0; t < grid.texelCount; ++t)
    for (std::size_t k = 0; k < count; ++k) sum[k] += static_cast<double>(values[t] * basis[t * count + k]);
  return sum;
}

std::vector<std::unique_ptr<VisibilityMethod>> makeShMethods(const VisibilityInput& input, const std::vector<int>& bands) {
  // Twice as fine as the maps, so that the projection is not what limits the higher bands.
  const OctahedralGrid grid(2 * input.resolution);
  const int most = *std::max_element(bands.begin(), bands.end());
  const auto count = static_cast<std::size_t>(most * most);
  const auto basis = weightedBasis(grid, most);
  std::vector<float> coefficients(input.encoded.size() * count);
  parallelBlocks(input.threads, input.encoded.size(), [&](std::size_t i) {
    const auto& viewpoint = input.viewpoints[input.encoded[i]];
    AlignedFloats cosine(grid.texelCount);
    TexelBits above, visible;
    texelsAbove(grid, viewpoint.normal, cosine, above);
    traceVisibility(input.rays, grid, viewpoint, above, visible);
    std::vector<double> sum(count, 0.0);
    for (std::size_t t = 0; t < grid.texelCount; ++t)
      if (texelBit(above.data(), t) && texelBit(visible.data(), t))
        for (std::size_t k = 0; k < count; ++k) sum[k] += static_cast<double>(basis[t * count + k]);
    for (std::size_t k = 0; k < count; ++k) coefficients[i * count + k] = static_cast<float>(sum[k]);
  });
  std::vector<std::unique_ptr<VisibilityMethod>> methods;
  for (const int b : bands) methods.push_back(std::make_unique<ShMethod>(input, b, coefficients, count));
  return methods;
}

}  // namespace chiaro
